"""The service from Python: submit lines, wait, and take the results as rows, typed documents or data frames.

    with Client("http://127.0.0.1:8000") as service:
        result = service.analyse(line, {"loops": [1]})

Documents are those of `app.schemas`, given as models or as mappings. What can be tried again is: a lost connection, a
service that is overloaded or away. Every POST carries an idempotency key, so that trying it again makes no second job.
"""

from app.client.client import Client, JobFailed
from app.client.connection import Refused, ServiceError, Show

__all__ = ["Client", "JobFailed", "Refused", "ServiceError", "Show"]
