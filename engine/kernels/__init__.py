"""The compiled forms of the inner loops (C), and the one module that calls them. Decision 0010."""
