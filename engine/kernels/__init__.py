"""The inner loops in C, and the one module that calls them. Decision 0010."""
