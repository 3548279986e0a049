"""The wheel as users install it, in a folder whose files are called like our packages and like those that we use."""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import zipfile
from collections.abc import Iterator, Mapping
from importlib.metadata import distribution
from pathlib import Path

import httpx
import pytest
from packaging.requirements import Requirement

from app.reference.source_lines import example
from tests.embedded import is_ready, submit, wait_for
from tests.servers import free_port, wait_until

ROOT = Path(__file__).parents[2]
HOSTILE = "raise SystemExit('imported from the folder of the user')\n"
NAMES = ("app", "engine", "worker", "migrations", "celery", "celeryconfig", "redis", "uvicorn", "alembic", "numpy")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build a wheel from a copy of the tree, so that nothing is written into the tree."""
    source, built = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("wheel")
    for name in ("pyproject.toml", "setup.py", "README.md"):
        shutil.copy(ROOT / name, source)
    for name in ("app", "engine", "migrations", "worker"):
        shutil.copytree(ROOT / name, source / name, ignore=shutil.ignore_patterns("__pycache__", "*.so"))
    environment = {**os.environ, "CFLAGS": "-O0"}
    command = [*_pip(), "wheel", "--quiet", "--no-deps", "--no-build-isolation", "--wheel-dir", str(built), str(source)]
    subprocess.run(command, check=True, env=environment, cwd=source)
    (found,) = built.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Install the wheel into a fresh environment that finds other packages where the tests find them."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(folder)], check=True)
    python = folder / "bin" / "python"
    command = [*_pip(python), "install", "--quiet", "--no-deps", "--no-index", str(wheel)]
    subprocess.run(
        command, check=True, env=_environment(), cwd=folder
    )  # away from the tree, where it would find itself
    (packages,) = folder.glob("lib/python*/site-packages")
    (packages / "others.pth").write_text(f"{sysconfig.get_path('purelib')}\n")  # its own .pth files are not read
    return python


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in NAMES:
        (tmp_path / f"{name}.py").write_text(HOSTILE)
    for name in NAMES[:4]:
        (tmp_path / name).mkdir()
        (tmp_path / name / "__init__.py").write_text(HOSTILE)
    return tmp_path


def _pip(python: Path | None = None) -> list[str]:
    return [sys.executable, "-m", "pip", *(["--python", str(python)] if python else [])]


def _environment(**values: str) -> Mapping[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("GALLOPING_", "PYTHON"))}
    return {**kept, **values}


@contextlib.contextmanager
def _serving(command: list[str], folder: Path, port: int) -> Iterator[httpx.Client]:
    arguments = [*command, "serve", "--port", str(port), "--data-dir", "kept"]
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(
            arguments, cwd=folder, env=_environment(), stdout=log, stderr=log, start_new_session=True
        )
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=60.0) as client:
            wait_until(lambda: process.poll() is not None or is_ready(client), 60.0, "readiness")
            assert process.poll() is None, (folder / "log").read_text()
            yield client
    finally:
        process.terminate()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(20.0)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)


def test_wheel_has_one_import_name(wheel: Path) -> None:
    names = {name.partition("/")[0] for name in zipfile.ZipFile(wheel).namelist()}
    assert {name for name in names if not name.endswith(".dist-info")} == {"galloping"}


def test_installed_kernels_run_without_their_sources(wheel: Path, installed: Path, folder: Path) -> None:
    """Installers write files in any order, so that sources would seem newer than what was built of them."""
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if name.endswith((".c", ".h"))]
    script = "from galloping.engine.kernels import compiled; print(compiled.AVAILABLE)"
    ended = _run([str(installed), "-P", "-c", script], folder)
    assert ended.stdout == "True\n", ended.stderr


@pytest.mark.parametrize("way", ["command", "module"])
def test_service_starts_and_computes_beside_files_of_the_same_names(installed: Path, folder: Path, way: str) -> None:
    command = [str(installed.parent / "galloping")] if way == "command" else [str(installed), "-P", "-m", "galloping"]
    asked = {"line": example("c11-single"), "analysis": {"models": ["hybrid"], "wind_speeds_m_per_s": [4.0]}}
    with _serving(command, folder, free_port()) as http:
        location = submit(http, asked)
        wait_for(http, location, "successful")
        assert http.get(f"{location}/results/limit-cycles").raise_for_status().json()
        assert http.get(f"{location}/plots/amplitude.svg").raise_for_status().content.startswith(b"<?xml")
        assert http.get("/", headers={"Accept": "text/html"}, follow_redirects=True).raise_for_status().text
        if way == "command":
            _use_the_client(installed, folder, str(http.base_url))


def _use_the_client(python: Path, folder: Path, url: str) -> None:
    """Run a script beside the folder's files, which are what it itself imports as `worker`."""
    (folder / "worker.py").write_text("NAME = 'of the user'\n")
    shutil.rmtree(folder / "worker")
    script = folder / "script.py"
    script.write_text(
        "import sys\nfrom galloping import Client, example\nimport worker\n"
        "with Client() as service:\n"
        "    job = service.submit(example('c11-single'), {'models': ['hybrid'], 'wind_speeds_m_per_s': [4.0]})\n"
        "    print(service.wait(job).status)\n"
        "print(worker.NAME, {'numpy', 'app', 'engine'} & set(sys.modules))\n"
    )
    ended = _run([str(python), str(script)], folder, GALLOPING_URL=url)
    assert ended.stdout.splitlines() == ["successful", "of the user set()"], ended.stderr


def test_client_needs_httpx_and_pydantic_only(installed: Path, folder: Path) -> None:
    """Other packages are out of sight here, so the rest of the command line says what it lacks."""
    few = folder / "few"
    few.mkdir()
    for name in sorted(_with_requirements({"httpx", "pydantic"})):
        for top in {path.parts[0] for path in distribution(name).files or () if path.parts[0] != ".."}:
            with contextlib.suppress(FileExistsError):
                (few / top).symlink_to(Path(sysconfig.get_path("purelib")) / top)
    (others,) = installed.parents[1].glob("lib/python*/site-packages/others.pth")
    all_others = others.read_text()
    others.write_text(f"{few}\n")
    try:
        script = (
            "from galloping import Client, example; print(Client('http://127.0.0.1:1'), example('c11-twin')['name'])"
        )
        ended = _run([str(installed), "-P", "-c", script], folder)
        lacking = _run([str(installed.parent / "galloping"), "analyse", "line.json"], folder)
    finally:
        others.write_text(all_others)
    assert ended.stdout.endswith("C11 twin, 126 m\n"), ended.stderr
    assert (lacking.returncode, lacking.stderr) == (
        1,
        "this command needs typer, which is not installed: pip install 'galloping[all]'\n",
    )


def test_client_and_command_line_need_nothing_that_windows_lacks(installed: Path, folder: Path) -> None:
    """Windows has not these modules and names, and opens text in another encoding than UTF-8 where none is named."""
    (folder / "line.json").write_text(json.dumps({**example("c11-single"), "name": "Łódź 110 kV"}), encoding="utf-8")
    script = """
import os, signal, sys
lacking = ("fcntl", "grp", "pty", "pwd", "readline", "resource", "syslog", "termios", "tty", "uvloop")
sys.modules.update(dict.fromkeys(lacking))  # an import of one of these fails
for name in ("SIGALRM", "SIGHUP", "SIGKILL", "SIGQUIT", "SIGUSR1", "pthread_sigmask"):
    delattr(signal, name)
for name in ("fork", "geteuid", "getpgid", "getuid", "killpg", "mkfifo", "setsid", "statvfs"):
    delattr(os, name)
from galloping import Client
from galloping.__main__ import main
Client("http://127.0.0.1:1").close()
sys.argv = ["galloping", *sys.argv[1:]]
main()
"""
    python = [str(installed), "-P", "-X", "warn_default_encoding", "-W", "error::EncodingWarning", "-c", script]
    analysed = _run([*python, "analyse", "line.json", "--output", "result.json", "--csv", "tables"], folder)
    assert analysed.returncode == 0, analysed.stderr
    result = json.loads((folder / "result.json").read_text(encoding="utf-8"))
    assert (result["verdict"][0]["gallops"], result["input"]["line"]["name"]) == ("yes", "Łódź 110 kV")
    assert (folder / "tables" / "verdict.csv").is_file()
    for words in (["--help"], ["serve", "--help"], ["resolve", "line.json"], ["conductors", "--search", "Drake"]):
        ended = _run([*python, *words], folder)
        assert (ended.returncode, bool(ended.stdout)) == (0, True), ended.stderr
    refused = _run([*python, "submit", "line.json", "--url", "http://127.0.0.1:1"], folder)
    assert (refused.returncode, "does not answer" in refused.stderr) == (1, True), refused.stderr


def _with_requirements(names: set[str]) -> set[str]:
    """Return names of distributions with those that they need here, without extras."""
    found, waiting = set(), set(names)
    while waiting:
        found.add(name := waiting.pop())
        needed = map(Requirement, distribution(name).requires or ())
        here = {one.name for one in needed if one.marker is None or one.marker.evaluate({"extra": ""})}
        waiting |= here - found
    return found


def _run(command: list[str], folder: Path, **values: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command, cwd=folder, env=_environment(**values), capture_output=True, text=True, timeout=60.0, check=False
    )
