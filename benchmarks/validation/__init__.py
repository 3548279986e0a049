"""docs/validation.md: the source's figures and other checks beside the engine's, a module for each section."""
