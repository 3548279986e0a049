"""The line of a job with a few of its values moved: which values have sliders, and what the moved line does."""
