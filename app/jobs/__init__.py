"""The life of a job: submitted, dispatched, leased, reused, concluded, and reported to its webhooks."""
