"""Run the process with the client that is generated from the schemas of OGC API - Processes 1.0, and holds to them."""

import json
import sys
import time
from pathlib import Path

from ogc_api_processes_client import Configuration
from ogc_api_processes_client.api_client_wrapper import ApiClientWrapper
from ogc_api_processes_client.exceptions import NotFoundException

PROCESS = "galloping"
HEADERS = {"Content-Type": "application/json", "Prefer": "respond-async"}

client = ApiClientWrapper(Configuration(host=sys.argv[1]))
assert {"self", "conformance", "http://www.opengis.net/def/rel/ogc/1.0/processes"} <= {
    link.rel for link in client.get_landing_page().links
}
assert client.get_conformance_classes().conforms_to
assert [summary.id for summary in client.get_processes().processes] == [PROCESS]
described = client.get_process_description(PROCESS)  # refuses a schema that is not one of OpenAPI 3.0
assert described.inputs.keys() == {"line", "analysis", "study", "placement", "remedies"}

inputs = {name: {"value": value} for name, value in json.loads(Path("request.json").read_text()).items()}
job = client.execute_simple(PROCESS, {"inputs": inputs, "response": "document"}, _headers=HEADERS)
deadline = time.monotonic() + 60.0
while job.status not in ("successful", "failed", "dismissed"):
    assert time.monotonic() < deadline, job
    time.sleep(0.1)
    job = client.get_status(job.job_id)
assert job.status == "successful", job
assert job.job_id in [listed.job_id for listed in client.get_jobs().jobs]
assert client.get_result(job.job_id)["result"].actual_instance.media_type == "application/json"
# Of a value that is an object its typed answer keeps nothing that is public.
answer = client.result_api.get_result_without_preload_content(job.job_id)
cycles = json.loads(answer.data)["result"]["value"]["limit_cycles"]

passing = client.execute_simple(PROCESS, {"inputs": inputs}, _headers=HEADERS)
assert client.dismiss(passing.job_id).status == "dismissed"
try:
    client.get_status("0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")
except NotFoundException as error:
    assert json.loads(error.body)["type"].endswith("/1.0/no-such-job")
else:
    raise AssertionError("no job, and a status")
print(json.dumps({"job": job.job_id, "vertical_m": cycles[-1]["vertical_m"]}))
