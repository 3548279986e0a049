"""What a process needs before it serves: settings, logs, telemetry, child processes. Nothing about jobs or HTTP."""
