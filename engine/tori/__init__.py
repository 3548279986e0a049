"""Quasi-periodic motions: two-frequency balance, stability, branches, search. Not the periodic ones."""
