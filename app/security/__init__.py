"""Who calls and what they may do: keys, scopes, quotas, audit, and where webhooks may go."""
