"""The result of phases that spacers tie, and the clearances between phases."""
