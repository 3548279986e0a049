import json
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from typing import Any

import httpx
import pytest

from app import convert
from app.answers.results import ResultDocument
from app.reference.source_lines import EXAMPLE_NAMES, example
from app.reference.source_studies import study_request
from app.runtime.settings import Settings
from app.schemas.placement import EXAMPLE
from tests.app.command_line import galloping, refused
from tests.app.known_documents import CONTRACT
from tests.app.lines import SHORT, changed
from tests.documents import short_request
from tests.processes import running_worker
from tests.servers import free_port


def written(directory: Path, name: str, document: Any) -> str:
    path = directory / f"{name}.json"
    path.write_text(json.dumps(document))
    return str(path)


def test_an_analysis_does_not_wait_for_scipy(tmp_path: Path) -> None:
    command = ["analyse", written(tmp_path, "line", short_request()), "--output", str(tmp_path / "result.json")]
    told = "import sys; from app.cli import main\ntry: main()\nfinally: print('scipy' in sys.modules)"
    ended = subprocess.run(
        [sys.executable, "-c", told, *command], capture_output=True, text=True, timeout=120.0, check=False
    )
    assert ended.stdout.strip() == "False", ended.stderr


def test_help_names_the_commands() -> None:
    ended = galloping("--help")
    assert ended.returncode == 0
    for command in ("analyse", "serve", "worker", "migrate", "submit", "example", "ellipse"):
        assert command in ended.stdout


@pytest.mark.parametrize("name", EXAMPLE_NAMES)
def test_an_example_is_printed_ready_to_run(name: str) -> None:
    assert json.loads(galloping("example", name).stdout) == example(name)


def test_an_unknown_example_is_refused_with_those_that_there_are() -> None:
    assert "c11-twin" in refused("example", "c12")
    assert "figure-4" in refused("example", "c11-twin", "--study", "figure-1")


def test_a_study_of_the_source_is_printed_as_a_whole_request_that_runs() -> None:
    request = json.loads(galloping("example", "--study", "figure-6", "c11-single").stdout)
    assert request == study_request("figure-6", "c11-single")
    request["analysis"]["wind_speeds_m_per_s"] = [4.0]
    result = json.loads(galloping("analyse", "-", text=json.dumps(request)).stdout)
    assert result["critical_wind_speeds"][0]["wind_speed_m_per_s"] == pytest.approx(3.94, rel=0.005)


def test_an_ellipse_of_design_practice_is_printed() -> None:
    """CIGRE's published example: S 20.65 ft, d 28.1432 mm, bundle: 20.0, 8 and 6 ft."""
    asked = ("--method", "cigre", "--sag-m", "6.2941", "--diameter-m", "0.0281432", "--subconductors", "2")
    found = json.loads(galloping("ellipse", *asked).stdout)
    assert list(found) == ["major_axis_m", "minor_axis_m", "b_m"]
    assert list(found.values()) == pytest.approx([6.10, 2.44, 1.83], abs=0.005)
    without = galloping("ellipse", "--method", "cigre", "--sag-m", "0.1", "--diameter-m", "0.0281432")
    assert set(json.loads(without.stdout).values()) == {None}


def test_an_ellipse_without_its_lengths_is_refused_with_their_options() -> None:
    assert "--span-m: is needed by toye" in refused("ellipse", "--method", "toye", "--sag-m", "2")
    told = refused("ellipse", "--method", "aeso", "--sag-m", "-2")
    assert "--sag-m: must be" in told
    assert "--diameter-m" in told


def test_the_twin_analysed_gives_the_figures_of_the_theory(tmp_path: Path) -> None:
    line = written(tmp_path, "line", example("c11-twin"))
    analysis = written(tmp_path, "analysis", {**SHORT, "loops": [1, 2]})
    ended = galloping("analyse", line, "--analysis", analysis)
    assert (ended.returncode, ended.stderr) == (0, "")
    result = ResultDocument.model_validate_json(ended.stdout)
    onset = [row.wind_speed_m_per_s for row in result.critical_wind_speeds]
    assert onset[:2] == [pytest.approx(2.403, rel=0.005), pytest.approx(2.250, rel=0.005)]
    found = {
        (row.loops, row.wind_speed_m_per_s, size): getattr(row, f"{size}_m")
        for row in result.limit_cycles
        if row.stability == "stable"
        for size in ("vertical", "horizontal")
    }
    assert found[1, 4.0, "vertical"] == pytest.approx(0.1568, rel=0.01)
    assert found[1, 6.0, "horizontal"] == pytest.approx(0.0275, rel=0.01)
    assert found[2, 4.0, "horizontal"] == pytest.approx(0.3571, rel=0.01)
    assert found[2, 6.0, "horizontal"] == pytest.approx(0.9425, rel=0.01)


def test_a_whole_request_is_taken_from_standard_input_and_its_result_put_into_a_file(tmp_path: Path) -> None:
    output = tmp_path / "result.json"
    ended = galloping("analyse", "-", "--output", str(output), text=json.dumps(short_request()))
    assert (ended.returncode, ended.stdout) == (0, "")
    assert ResultDocument.model_validate_json(output.read_bytes()).frequencies[0].loops == 1


def test_a_study_gives_the_same_tables_with_its_axes(tmp_path: Path) -> None:
    axis = {"parameter": "span.horizontal_tension_n", "values": [24000, 36000]}
    study = written(tmp_path, "study", {"axes": [axis]})
    request = written(tmp_path, "request", {**short_request(), "analysis": {**SHORT, "wind_speeds_m_per_s": []}})
    result = json.loads(galloping("analyse", request, "--study", study).stdout)
    assert [row["span.horizontal_tension_n"] for row in result["frequencies"]] == [24000, 36000]
    assert [row["horizontal_tension_n"] for row in result["static"]] == [24000, 36000]


def test_places_are_sought_beside_the_devices_of_the_line(tmp_path: Path) -> None:
    analysis = written(tmp_path, "analysis", SHORT | {"wind_speeds_m_per_s": []})
    placement = written(tmp_path, "placement", EXAMPLE | {"generations": 1, "population": 5})
    line = written(tmp_path, "line", example("c11-twin"))
    ended = galloping("analyse", line, "--analysis", analysis, "--placement", placement)
    result = json.loads(ended.stdout)
    assert [row["device"] for row in result["placements"]] == [0, 1]
    assert [row["loops"] for row in result["device_effects"]] == [1]
    assert result["input"]["placement"]["generations"] == 1


def test_a_statically_divergent_line_is_an_answer(tmp_path: Path) -> None:
    line = written(tmp_path, "line", changed("span.length_m", 200.0, example("c11-single")))
    ended = galloping("analyse", line, "--analysis", written(tmp_path, "analysis", SHORT))
    assert ended.returncode == 0, ended.stderr
    assert {row["outcome"] for row in json.loads(ended.stdout)["limit_cycles"]} == {"statically_unstable"}


@pytest.mark.parametrize(
    ("document", "names"),
    [
        (changed("span.length_m", -1.0), ["/line/span/length_m"]),
        (changed("span.length_m", 1e9), ["/line/span/length_m"]),
        (changed("span.length_m", float("nan")), ["/line/span/length_m"]),
        (changed("span.length_m", "126"), ["/line/span/length_m"]),
        (changed("devices.0.position_m", 300.0, changed("conductor.x", 1)),
         ["/line/conductor/x", "/line/devices/0/position_m"]),
        ({"line": changed("span.sag_m", 1.0), "analysis": {"loops": [0]}}, ["/line/span", "/analysis/loops/0"]),
        ({"line": example("c11-twin"), "study": {"axes": [{"parameter": "span.x_m", "values": [1]}]}},
         ["/study/axes/0/parameter"]),
        ([], ["/line"]),
        (None, ["/line"]),
    ],
)  # fmt: skip
def test_bad_input_ends_with_2_and_names_every_field(tmp_path: Path, document: Any, names: list[str]) -> None:
    message = refused("analyse", written(tmp_path, "line", document))
    assert sorted(line.split(":")[0] for line in message.splitlines()) == sorted(names)


def test_what_cannot_be_read_ends_with_2_and_names_the_file(tmp_path: Path) -> None:
    broken, line = tmp_path / "broken.json", written(tmp_path, "line", example("c11-twin"))
    broken.write_bytes(b'{"span": \xff')
    assert str(broken) in refused("analyse", str(broken))
    assert "missing.json" in refused("analyse", str(tmp_path / "missing.json"))
    assert str(tmp_path) in refused("analyse", str(tmp_path))
    assert str(broken) in refused("analyse", line, "--analysis", str(broken))
    assert "not valid JSON" in refused("analyse", "-", text="[" * 100_000)
    assert "/span/sag_m: appears more than once" in refused("analyse", "-", text='{"span": {"sag_m": 1, "sag_m": 2}}')


def test_what_is_given_twice_is_refused(tmp_path: Path) -> None:
    request, analysis = written(tmp_path, "request", short_request()), written(tmp_path, "analysis", SHORT)
    assert "analysis is given twice" in refused("analyse", request, "--analysis", analysis)


def test_a_result_that_cannot_be_written_ends_with_2(tmp_path: Path) -> None:
    request = written(tmp_path, "request", short_request())
    assert "cannot be written" in refused("analyse", request, "--output", str(tmp_path / "no" / "result.json"))
    (tmp_path / "file").touch()
    for option in ("--csv", "--plots"):
        folder = str(tmp_path / "file" / "folder")
        assert f"{folder} cannot be written: " in refused("analyse", request, option, folder)


def test_wrong_settings_end_with_2_and_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_DATABASE_URL", "mysql://x")
    told = refused("migrate", "--data-dir", str(tmp_path))
    assert told == "GALLOPING_DATABASE_URL: must begin with sqlite:/// or postgresql://\n"


def test_settings_that_contradict_each_other_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GALLOPING_HEARTBEAT_SECONDS", "20")
    told = refused("migrate", "--data-dir", str(tmp_path))
    assert told == "heartbeat_seconds must be at most half of lease_seconds\n"


@pytest.mark.parametrize("command", ["migrate", "serve"])
def test_a_directory_that_cannot_be_made_ends_with_2_and_is_named(tmp_path: Path, command: str) -> None:
    (tmp_path / "file").write_text("in the way")
    for place in (tmp_path / "file", tmp_path / "file" / "below", Path("/proc/x")):
        told = refused(command, "--data-dir", str(place))
        assert told.startswith(str(place))
        assert len(told.splitlines()) == 1


@pytest.mark.parametrize("command", ["migrate", "serve"])
@pytest.mark.parametrize(
    "url", ["postgresql://nobody:secret@127.0.0.1:{port}/x", "postgresql://[", "sqlite:////proc/x/y"]
)
def test_a_database_that_cannot_be_used_ends_with_2(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, url: str
) -> None:
    monkeypatch.setenv("GALLOPING_DATABASE_URL", url.replace("{port}", str(free_port())))
    told = refused(command, "--data-dir", str(tmp_path))
    assert len(told.splitlines()) == 1
    assert "cannot be used" in told
    assert "secret" not in told


def test_a_database_of_a_newer_version_ends_with_2(tmp_path: Path) -> None:
    assert galloping("migrate", "--data-dir", str(tmp_path)).returncode == 0
    with closing(sqlite3.connect(tmp_path / "galloping.sqlite3")) as database, database:
        database.execute("UPDATE alembic_version SET version_num = '9999'")
    for words in (("migrate",), ("migrate", "--to", "0021"), ("serve",), ("keys", "list")):
        told = refused(*words, "--data-dir", str(tmp_path))
        assert "has the schema 9999 of a newer version, whose `galloping migrate --to 00" in told


def test_analyse_runs_on_one_blas_thread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    program = (
        "import os, sys\n"
        "def hook(event, said):\n"
        "    if event == 'import' and said[0] == 'numpy':\n"
        "        print(os.environ['OPENBLAS_NUM_THREADS'], file=sys.stderr)\n"
        "sys.addaudithook(hook)\n"
        "from app.cli import main\n"
        "main()\n"
    )
    command = [sys.executable, "-c", program, "analyse", written(tmp_path, "request", short_request())]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120.0, check=True)
    assert set(ended.stderr.split()) == {"1"}


def test_migrate_makes_the_database(tmp_path: Path) -> None:
    assert galloping("migrate", "--data-dir", str(tmp_path / "new")).returncode == 0
    assert (tmp_path / "new" / "galloping.sqlite3").stat().st_size > 0


def test_submit_prints_the_status_of_the_job(tmp_path: Path, own_client: httpx.Client) -> None:
    request = written(tmp_path, "request", short_request())
    ended = galloping("submit", request, "--url", str(own_client.base_url))
    assert ended.returncode == 0, ended.stderr
    job = json.loads(ended.stdout)
    assert own_client.get(f"/v1/jobs/{job['id']}").json()["status"] == "accepted"


def test_submit_waits_for_the_result(tmp_path: Path, own_settings: Settings, own_client: httpx.Client) -> None:
    request = written(tmp_path, "request", short_request())
    with running_worker(own_settings.model_copy(update={"worker_processes": 1})):
        ended = galloping("submit", request, "--wait", "--url", str(own_client.base_url))
    assert ended.returncode == 0, ended.stderr
    assert ResultDocument.model_validate_json(ended.stdout).engine_version


def test_submit_names_the_fields_that_the_service_refuses(tmp_path: Path, own_client: httpx.Client) -> None:
    line = written(tmp_path, "line", changed("span.length_m", float("nan"), changed("conductor.x", 1)))
    message = refused("submit", line, "--url", str(own_client.base_url))
    assert {line.split(":")[0] for line in message.splitlines()} == {"/line/conductor/x", "/line/span/length_m"}


@pytest.mark.parametrize("url", ["http://127.0.0.1:{port}", "nonsense", "http://[::1", "ftp://127.0.0.1"])
def test_a_service_that_is_not_there_is_said_so(tmp_path: Path, url: str) -> None:
    address = url.replace("{port}", str(free_port()))
    ended = galloping("submit", written(tmp_path, "request", short_request()), "--url", address)
    assert ended.returncode == 1
    assert address in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_line_is_resolved_wrapped_or_not(tmp_path: Path) -> None:
    for document in (CONTRACT, {"line": CONTRACT}):
        ended = galloping("resolve", written(tmp_path, "line", document))
        assert ended.returncode == 0, ended.stderr
        found = json.loads(ended.stdout)
        assert found["line"]["conductor"]["diameter_m"] == 0.02814
        assert {row["origin"] for row in found["assumptions"]} == {"given", "catalogue", "computed", "assumed"}


def test_a_line_that_cannot_be_resolved_is_refused(tmp_path: Path) -> None:
    wrong = {**CONTRACT, "conductor": {"catalogue": "Drak"}}
    assert "/conductor/catalogue: must name" in refused("resolve", written(tmp_path, "line", wrong))


def test_an_analysis_takes_a_line_as_an_engineer_knows_it(tmp_path: Path) -> None:
    asked = {"loops": [1], "wind_speeds_m_per_s": [5.0], "uncertainty": {"samples": 0}}
    analysis = written(tmp_path, "analysis", asked)
    results = []
    for number, document in enumerate([CONTRACT, convert.resolve_document(CONTRACT)["line"]]):
        ended = galloping("analyse", written(tmp_path, f"line-{number}", document), "--analysis", analysis)
        assert ended.returncode == 0, ended.stderr
        results.append(json.loads(ended.stdout))
    assert results[0]["critical_wind_speeds"]
    assert {row["origin"] for row in results[0].pop("assumptions")} == {"given", "catalogue", "computed", "assumed"}
    assert results[1].pop("assumptions") == []
    assert results[0]["input"].pop("known")["line"] == CONTRACT
    assert results[0] == results[1]


def test_distances_to_phases_are_those_of_an_analysis(tmp_path: Path) -> None:
    line = {**example("c11-twin"), "phases": [{"name": "top", "y_m": 2.0}], "required_clearance_m": 1.0}
    path = written(tmp_path, "line", line)
    asked = written(tmp_path, "analysis", SHORT)
    found = json.loads(galloping("clearance", path, "--analysis", asked).stdout)
    whole = json.loads(galloping("analyse", path, "--analysis", asked).stdout)
    assert found == {name: whole[name] for name in ("verdict", "clearances", "warnings", "failures")}
    (verdict,) = found["verdict"]
    stable = [row for row in found["clearances"] if row["method"] == "computed" and row["stability"] == "stable"]
    assert verdict["clearance_m"] == min(row["distance_m"] for row in stable) < 2.0
    assert verdict["clearance_margin_m"] == pytest.approx(verdict["clearance_m"] - 1.0)
    assert {row["method"] for row in found["clearances"]} == {"computed", "davison", "toye", "cigre", "aeso"}


def test_distances_need_phases(tmp_path: Path) -> None:
    path = written(tmp_path, "line", example("c11-twin"))
    assert "/line/phases: must list the phases" in refused("clearance", path)
