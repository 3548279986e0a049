import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from app.reference.source_lines import EXAMPLE_NAMES
from tests.servers import wait_until


@pytest.fixture(scope="module")
def demonstrated(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """Run the demo once, and give what it printed and where it put its files."""
    output = tmp_path_factory.mktemp("demo") / "output"
    command = [sys.executable, "-m", "app.cli.demo", "--output", str(output)]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=240.0, check=False)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout, output


def rows(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_all_72_frequencies_stand_beside_the_source(demonstrated: tuple[str, Path]) -> None:
    found = re.findall(r"(\d\.\d{4}) (\d\.\d{3}) ([+-]\d\.\d\d)", demonstrated[0])
    assert len(found) == 72
    for ours, theirs, difference in found:
        assert abs(100.0 * (float(ours) / float(theirs) - 1.0) - float(difference)) < 0.02
        assert abs(float(difference)) < 1.0


def test_what_is_printed_fits_a_terminal_of_80_columns(demonstrated: tuple[str, Path]) -> None:
    assert max(len(line.rstrip()) for line in demonstrated[0].splitlines()[:-1]) <= 80


@pytest.mark.parametrize("name", EXAMPLE_NAMES)
def test_every_line_has_its_tables_and_pictures(demonstrated: tuple[str, Path], name: str) -> None:
    output = demonstrated[1]
    assert len(rows(output / f"{name}-frequencies.csv")) == 6
    assert len(rows(output / f"{name}-critical-wind-speeds.csv")) >= 4
    stable = [row for row in rows(output / f"{name}-limit-cycles.csv") if row["stability"] == "stable"]
    assert {(row["model"], row["loops"]) for row in stable} >= {("hybrid", "1"), ("finite_element", "2")}
    assert {row["wind_speed_m_per_s"] for row in stable} == {"4.0", "4.5", "5.0", "5.5", "6.0"}
    for picture in ("amplitude", "orbit"):
        assert b"</svg>" in (output / f"{name}-{picture}.svg").read_bytes()


def test_nothing_of_its_service_is_left_running(demonstrated: tuple[str, Path]) -> None:
    data = str(demonstrated[1] / "service").encode()

    def left() -> list[str]:
        return [path.parent.name for path in Path("/proc").glob("[0-9]*/environ") if _mentions(path, data)]

    wait_until(lambda: not left(), 10.0, "the end of the service")


def _mentions(path: Path, data: bytes) -> bool:
    try:
        return data in path.read_bytes() and int(path.parent.name) != os.getpid()
    except OSError:
        return False
