"""Limit cycles: first harmonic, harmonic balance, Floquet multipliers, branches, bifurcations, search. No tori."""
