"""Data that ships with the service: conductors, and the lines and studies of the source."""
