"""OGC API - Processes, part 1: thin routes over the same jobs, for the clients of that standard."""
