"""The chart of amplitudes over the wind speed: its curves, stored with the result or computed when it is shown."""
