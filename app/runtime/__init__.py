"""What a process needs before it serves: settings, logs, telemetry, child processes. No jobs, no HTTP."""
