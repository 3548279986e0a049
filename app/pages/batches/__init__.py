"""A batch as a page shows it: its lines in order of their motion, how these are spread, and where the lines stand."""
