"""Commands for the operator of a service: to run it, to watch it, and to keep its keys."""
