"""The result of a section of several spans: the tables of a single span, and the table of its modes."""
