"""Commands that work with a running service: `galloping submit`, `jobs` and `batch`."""
