"""Data that ships with the service: conductors, the source's lines and its studies."""
