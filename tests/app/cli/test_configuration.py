"""The configuration file: found at its usual place or by name, after options and environment, refused where wrong."""

import json
from pathlib import Path

import httpx
import pytest

from app.runtime.settings import Settings
from tests.app.command_line import on_a_terminal, refused, run


def written(file: Path, text: str) -> Path:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)
    return file


def test_an_option_goes_before_the_environment_and_that_before_the_file(
    own_client: httpx.Client, tmp_path: Path
) -> None:
    here, nowhere = str(own_client.base_url), "http://127.0.0.1:9"
    right, wrong = (
        str(written(tmp_path / name, f'url = "{url}"')) for name, url in (("a.toml", here), ("b.toml", nowhere))
    )
    listed = ("jobs", "list", "--config")
    assert json.loads(run(*listed, right).stdout) == {"jobs": []}
    assert f"{nowhere} does not answer" in run(*listed, wrong).stderr
    assert json.loads(run(*listed, wrong, environment={"GALLOPING_URL": here}).stdout) == {"jobs": []}
    assert json.loads(run(*listed, wrong, "--url", here, environment={"GALLOPING_URL": nowhere}).stdout) == {"jobs": []}
    assert json.loads(run("jobs", "list", environment={"GALLOPING_CONFIG": right}).stdout) == {"jobs": []}


def test_the_usual_file_and_its_paths(tmp_path: Path, own_client: httpx.Client, own_settings: Settings) -> None:
    environment = {"XDG_CONFIG_HOME": str(tmp_path / "home"), "HOME": str(tmp_path)}
    folder = tmp_path / "home" / "galloping"
    text = f'url = "{own_client.base_url}"\nkey_file = "key"\ndata_dir = "{own_settings.data_dir}"\nquiet = true\n'
    written(folder / "config.toml", text)
    made = run("keys", "create", "--owner", "acme", environment=environment)  # data_dir and quiet from the file
    assert (made.returncode, made.stderr) == (0, "")
    written(folder / "key", made.stdout)  # named from the folder of the file
    assert json.loads(run("jobs", "list", environment=environment).stdout) == {"jobs": []}
    refusal = run("jobs", "list", environment={**environment, "GALLOPING_KEY": "galloping_wrong"})
    assert "401" in refusal.stderr  # the key of the environment goes before the file


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('units = "miles"', "units: must be si or feet, got 'miles'"),
        ('adress = "x"', "adress: is not known; may be url, key_file"),
        ('port = "8000"', "port: must be a whole number, got '8000'"),
        ("quiet = 1", "quiet: must be true or false, got 1"),
        ("url = ", "Invalid value"),
    ],
)
def test_what_is_wrong_is_named_with_its_rule(tmp_path: Path, text: str, told: str) -> None:
    file = written(tmp_path / "wrong.toml", text)
    ended = run("conductors", "--config", str(file))
    assert (ended.returncode, ended.stdout) == (2, "")
    assert f"{file}: {told}" in ended.stderr


def test_units_and_folder_of_results(tmp_path: Path) -> None:
    line = written(tmp_path / "line.json", run("example", "c11-single").stdout)
    analysis = written(tmp_path / "a.json", '{"models": ["hybrid"], "loops": [1], "wind_speeds_m_per_s": [4.0]}')
    file = written(tmp_path / "file.toml", 'units = "feet"\noutput_dir = "made/for it"\n')
    asked = ("analyse", str(line), "--analysis", str(analysis), "--config", str(file))
    shown = on_a_terminal(*asked, "--output", "result.json", "--csv", "tables")
    assert "from mph" in shown and "peak to peak [ft, rad]" in shown
    onset = json.loads((tmp_path / "made" / "for it" / "result.json").read_text())["verdict"][0]["onset_m_per_s"]
    assert f"{onset / 0.44704:.2f}" in shown
    assert "wind_speed_m_per_s" in (tmp_path / "made" / "for it" / "tables" / "limit_cycles.csv").read_text()
    aside = tmp_path / "aside.json"
    assert "from m/s" in on_a_terminal(*asked, "--units", "si", "--output", str(aside))
    assert aside.is_file()
    here = tmp_path / "here"
    ended = run(*asked, "--output-dir", str(here), "--output", "result.json")
    assert (ended.returncode, ended.stdout) == (0, "") and (here / "result.json").is_file()
    assert "cannot be made" in run(*asked, "--output-dir", str(aside), "--output", "result.json").stderr


def test_a_named_file_must_exist(tmp_path: Path) -> None:
    assert "none.toml cannot be read" in refused("conductors", "--config", str(tmp_path / "none.toml"))


def test_quiet_leaves_out_notes_before_or_after_the_command(tmp_path: Path) -> None:
    for number, arguments in enumerate((["--quiet", "keys", "create"], ["keys", "create", "-q"])):
        made = run(*arguments, "--owner", "acme", "--data-dir", str(tmp_path / str(number)))
        assert (made.returncode, made.stderr) == (0, "")
        assert made.stdout.startswith("galloping_")
    aloud = run("keys", "create", "--owner", "acme", "--data-dir", str(tmp_path / "0"))
    assert "Store this key" in aloud.stderr
