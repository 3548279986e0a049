"""Reduced models: aerodynamic load, hybrid and finite element model, critical wind speeds. No limit cycles."""
