"""The database: connections, migrations, stored results, counters. The rules for jobs are in `app.jobs`."""
