"""Answers shared between requests: grouped calls, shared watches, an expiring cache."""
