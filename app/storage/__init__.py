"""The database: connections, migrations, stored results, counters. What a job may do is in `app.jobs`."""
