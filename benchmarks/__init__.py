"""Measurements and tables that the documents quote; nothing of the product imports this."""
