"""The command that sends one line to a service: `galloping submit`."""

import json
from typing import Annotated

import typer

from app.cli.console import FAILED, end, try_output, write
from app.cli.inputs import read_request
from app.cli.options import AnalysisFile, DefaultsFile, LineFile, OutputFile, StudyFile
from app.cli.remote.calls import DEFAULT_URL, KeyFile, ServiceUrl, service_at, waited_for

Wait = Annotated[bool, typer.Option("--wait", help="Wait until the job ends and print the result.")]


def submit(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    line: LineFile,
    analysis: AnalysisFile = None,
    study: StudyFile = None,
    defaults: DefaultsFile = None,
    url: ServiceUrl = DEFAULT_URL,
    key_file: KeyFile = None,
    wait: Wait = False,
    output: OutputFile = None,
) -> None:
    """Send a line to a service and print the job's status, or with --wait its result."""
    try_output(output)
    document = read_request(line, analysis, study, defaults=defaults)
    with service_at(url, key_file) as service:
        job = service.submit_document(document)
        if not wait:
            write(job.model_dump(mode="json"), output)
            return
        job = waited_for(service, job, url)
        if job.status == "dismissed":
            end("the job was cancelled", FAILED)
        write(json.loads(service.download(job, "results")), output)
    if job.failure is not None:
        end(f"the job failed: {job.failure.detail}", FAILED)
