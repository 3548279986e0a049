"""How much of the time, in the climate of a line, the wind and the ice make it gallop."""
