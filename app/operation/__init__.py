"""Tools for the service's operator: metrics, status, pruning, and the list of workers."""
