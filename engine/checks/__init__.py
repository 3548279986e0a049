"""Checks of limit cycles by other means than the harmonic balance: direct integration, measures of confidence."""
