"""Submit a line with the Python client that openapi-generator makes, poll, and read typed results."""

import json
import sys
import time
from pathlib import Path

from galloping_client import ApiClient, ApiException, Configuration, JobRequest, JobsApi, LimitCycle, ResultsApi

given = json.loads(Path("request.json").read_text())
with ApiClient(Configuration(host=sys.argv[1])) as client:
    jobs = JobsApi(client)
    request = JobRequest.from_dict(given)
    assert jobs.estimate_job(request).points == 1
    job = jobs.submit_job(request)
    deadline = time.monotonic() + 60.0
    while job.status not in ("successful", "failed", "dismissed"):
        assert time.monotonic() < deadline, job
        time.sleep(0.1)
        job = jobs.job_status(job.id)
    assert job.status == "successful", job
    row = ResultsApi(client).job_results(job.id).limit_cycles[-1]
    assert isinstance(row, LimitCycle)
    assert isinstance(row.vertical_m, float)
    try:
        ResultsApi(client).job_results("0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")
    except ApiException as error:
        assert error.status == 404
    print(json.dumps({"job": str(job.id), "vertical_m": row.vertical_m}))
