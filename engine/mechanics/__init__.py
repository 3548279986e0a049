"""From a line to matrices and modes: statics, cross-sections, finite elements, static twist. No motion."""
