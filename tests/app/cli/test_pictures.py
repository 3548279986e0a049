import json
from pathlib import Path
from typing import Any
from unittest import mock

import pytest
from typer.testing import CliRunner

from app.cli import app
from tests.documents import short_request

RUN = CliRunner()
STUDY = {"axes": [{"parameter": "span.horizontal_tension_n", "values": [24000.0, 30000.0]}]}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a directory with result documents: of a line, with pictures drawn at once, and of a study."""
    here = tmp_path_factory.mktemp("results")
    for name, document in (("line", short_request()), ("study", {**short_request(), "study": STUDY})):
        (here / f"{name}-request.json").write_text(json.dumps(document))
        files = ["--output", str(here / f"{name}.json"), "--plots", str(here / f"{name}-plots")]
        assert RUN.invoke(app, ["analyse", str(here / f"{name}-request.json"), *files]).exit_code == 0
    return here


def plot(*arguments: str | Path) -> Any:
    return RUN.invoke(app, ["plot", *map(str, arguments)])


def test_analyse_draws_what_plot_draws_from_the_stored_result(results: Path, tmp_path: Path) -> None:
    assert plot(results / "line.json", "--output", tmp_path).exit_code == 0
    drawn = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    assert set(drawn) == {"verdict.svg", "amplitude.svg", "orbit.svg", "modes.svg"}
    assert drawn == {path.name: path.read_bytes() for path in (results / "line-plots").iterdir()}
    assert b"C11 twin" in drawn["orbit.svg"]


def test_one_picture_goes_into_a_file_in_the_format_of_its_name(results: Path, tmp_path: Path) -> None:
    answer = plot(results / "line.json", "--picture", "amplitude", "--output", tmp_path / "a.png", "--size", "300x400")
    assert answer.exit_code == 0
    head = (tmp_path / "a.png").read_bytes()[:24]
    assert head.startswith(b"\x89PNG")
    assert (int.from_bytes(head[16:20]), int.from_bytes(head[20:24])) == (300, 400)


def test_millimetres_are_printed_at_300_dots_an_inch(results: Path, tmp_path: Path) -> None:
    file = tmp_path / "a.png"
    assert plot(results / "line.json", "--picture", "verdict", "--output", file, "--size", "127x101.6mm").exit_code == 0
    head = file.read_bytes()[:24]
    assert (int.from_bytes(head[16:20]), int.from_bytes(head[20:24])) == (1500, 1200)


def test_a_study_is_drawn_as_a_whole_or_point_by_point(results: Path, tmp_path: Path) -> None:
    assert [path.name for path in (results / "study-plots").iterdir()] == ["study.svg"]
    assert plot(results / "study.json", "--point", "1", "--picture", "orbit", "--output", tmp_path).exit_code == 0
    assert b"30 kN a conductor" in (tmp_path / "orbit.svg").read_bytes()


def test_a_picture_goes_to_standard_output(results: Path) -> None:
    answer = plot(results / "line.json", "--picture", "modes", "--output", "-", "--theme", "dark")
    assert answer.stdout_bytes.startswith(b"<?xml")
    assert b"#14181d" in answer.stdout_bytes


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (("line.json", "--picture", "x"), "there is no picture 'x'; choose of verdict, amplitude"),
        (("line.json", "--size", "x"), "--size must be WIDTHxHEIGHT"),
        (("line.json", "--size", "9x"), "--size: width must be between 240 and 4096 px, got 9"),
        (("line.json", "--output", "all.svg"), "4 pictures do not go into one file"),
        (("study.json", "--picture", "orbit"), "orbit is of one point: give --point"),
        (("study.json", "--point", "2"), "the study has no point 2"),
        (("line-request.json",), "is no result document: it lacks input"),
    ],
)
def test_what_cannot_be_drawn_ends_with_a_sentence(results: Path, arguments: tuple[str, ...], expected: str) -> None:
    answer = plot(results / arguments[0], *arguments[1:])
    assert (answer.exit_code, expected in answer.stderr) == (2, True), answer.stderr


def test_a_result_that_cannot_be_computed_again_says_why(results: Path, tmp_path: Path) -> None:
    with mock.patch("app.convert.run", side_effect=ValueError("it breaks")):
        answer = plot(results / "line.json", "--picture", "orbit", "--output", tmp_path)
    assert answer.exit_code == 1
    assert "orbit: what the document does not hold cannot be computed: it breaks" in answer.stderr
