"""The form of a line: its fields from the schemas, its texts as a request and back, and what the line becomes."""
