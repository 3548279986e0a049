"""Many lines under one analysis: run in stacks of the engine, and what they cost."""
