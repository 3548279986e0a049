"""Quasi-periodic motions: two-frequency balance, stability, branches, search. No periodic motions."""
