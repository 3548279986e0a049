"""From what a utility knows to an explicit line: sections of ice, estimates, change of state, origins. No analysis."""
