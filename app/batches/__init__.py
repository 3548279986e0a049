"""Many lines under one analysis: intake, records, results line by line, and rankings."""
