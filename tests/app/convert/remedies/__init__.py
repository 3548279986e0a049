"""Tests of remedies through the border."""
