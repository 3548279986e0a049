"""The life of a job: submit, dispatch, lease, reuse, finish, and send its webhooks."""
