"""Where motions are observed: in a single span by its number of loops, in a section where it moves most. No rows."""
