"""The Python client: submit lines, wait, and read the results as rows, typed documents or data frames.

    with Client("http://127.0.0.1:8000") as service:
        result = service.analyse(line, {"loops": [1]})

Documents follow `app.schemas`, as models or as mappings. The client retries when a connection is lost or the service is
overloaded or down. Every POST carries an idempotency key, so a retry creates no second job.
"""

from app.client.client import Client, JobFailed
from app.client.connection import NotFound, Refused, ServiceError, Show

__all__ = ["Client", "JobFailed", "NotFound", "Refused", "ServiceError", "Show"]
