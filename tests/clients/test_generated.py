"""Generated clients of the served document, and of OGC API - Processes: each submits a line, polls, reads results."""

import json
import shutil
from pathlib import Path

import httpx
import pytest

from tests.clients.tools import HERE, PROGRAMS, run, tool


def held(served: httpx.Client, printed: str) -> None:
    """Compare what a generated client read with what the service answers."""
    told = json.loads(printed.splitlines()[-1])
    cycles = served.get(f"/v1/jobs/{told['job']}/results/limit-cycles").raise_for_status().json()["limit_cycles"]
    assert told["vertical_m"] == pytest.approx(cycles[-1]["vertical_m"])


def test_spectral_finds_nothing(work: Path) -> None:
    spectral = tool("node_modules/.bin/spectral", needs="node")
    run(spectral, "lint", "--fail-severity", "hint", "--ruleset", HERE / "spectral.yaml", "openapi.json", folder=work)


def test_openapi_python_client(served: httpx.Client, work: Path) -> None:
    generator = tool("bin/openapi-python-client")
    options = ["--meta", "none", "--output-path", "galloping_client"]
    assert "Unable to parse" not in run(generator, "generate", "--path", "openapi.json", *options, folder=work)
    program = PROGRAMS / "openapi_python_client.py"
    held(served, run(tool("bin/python"), program, str(served.base_url), folder=work, PYTHONPATH=str(work)))


def test_client_of_ogc_api_processes(served: httpx.Client, work: Path) -> None:
    program = PROGRAMS / "ogc_processes.py"
    held(served, run(tool("bin/python"), program, str(served.base_url.join("/ogc")), folder=work))


def test_openapi_ts(served: httpx.Client, work: Path) -> None:
    generator, compiler = (tool(f"node_modules/.bin/{name}", needs="node") for name in ("openapi-ts", "tsc"))
    for file in PROGRAMS.glob("*.ts*"):
        shutil.copy(file, work)
    shutil.copy(PROGRAMS / "tsconfig.json", work)
    run(generator, "-i", "openapi.json", "-o", "client", "-c", "@hey-api/client-fetch", folder=work)
    run(compiler, "--project", "tsconfig.json", folder=work)
    node = shutil.which("node")
    assert node is not None
    held(served, run(node, "built/program.js", str(served.base_url), folder=work))


def test_openapi_generator(served: httpx.Client, work: Path) -> None:
    generator = tool("bin/openapi-generator-cli", needs="java")
    options = ["--global-property", "apiTests=false,modelTests=false,apiDocs=false,modelDocs=false"]
    named = ["--additional-properties", "packageName=galloping_client"]
    run(generator, "generate", "-i", "openapi.json", "-g", "python", "-o", "made", *options, *named, folder=work)
    program, made = PROGRAMS / "openapi_generator.py", str(work / "made")
    held(served, run(tool("bin/python"), program, str(served.base_url), folder=work, PYTHONPATH=made))
