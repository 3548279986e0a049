"""Submit a line with the client that openapi-python-client makes, poll, and read typed results."""

import json
import sys
import time
from pathlib import Path

from galloping_client import Client
from galloping_client.api.batches import submit_batch
from galloping_client.api.jobs import estimate_job, job_status, submit_job
from galloping_client.api.results import job_results
from galloping_client.models import (
    BatchDocument,
    BatchRequest,
    JobDocument,
    JobEstimate,
    JobRequest,
    LimitCycle,
    Problem,
    ResultDocument,
)

given = json.loads(Path("request.json").read_text())
request = JobRequest.from_dict(given)
with Client(base_url=sys.argv[1]) as client:
    estimate = estimate_job.sync(client=client, body=request)
    assert isinstance(estimate, JobEstimate)
    assert estimate.points == 1
    job = submit_job.sync(client=client, body=request)
    assert isinstance(job, JobDocument)
    deadline = time.monotonic() + 60.0
    while job.status not in ("successful", "failed", "dismissed"):
        assert time.monotonic() < deadline, job
        time.sleep(0.1)
        job = job_status.sync(job.id, client=client)
        assert isinstance(job, JobDocument)
    assert job.status == "successful", job
    result = job_results.sync(job.id, client=client)
    assert isinstance(result, ResultDocument)
    row = result.limit_cycles[-1]
    assert isinstance(row, LimitCycle)
    assert isinstance(row.vertical_m, float)
    batch = submit_batch.sync(client=client, body=BatchRequest.from_dict({"lines": [given["line"]]}))
    assert isinstance(batch, BatchDocument)
    assert batch.lines.total == 1
    request.line.span.length_m = -1.0
    refused = submit_job.sync(client=client, body=request)
    assert isinstance(refused, Problem)
    assert refused.errors[0].pointer == "/line/span/length_m"
    print(json.dumps({"job": str(job.id), "vertical_m": row.vertical_m}))
