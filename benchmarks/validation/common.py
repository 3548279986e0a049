"""What the sections share: the source's lines analysed once, references, and tables in Markdown."""

import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from benchmarks.lines import source_line
from engine.analysis import analyse
from engine.progress import finished
from engine.result import Result
from engine.spec import Analysis, Line

ROOT = Path(__file__).parents[2]
REFERENCE = json.loads((ROOT / "benchmarks" / "reference.json").read_text())
WINDS = (4.0, 6.0)
SUBCONDUCTORS = (1, 2, 3, 4)


@cache
def source_results() -> Mapping[int, Result]:
    """Analyse the source's lines at one to three loops and both winds of the source; by number of sub-conductors."""
    return {n: result(source_line(n), Analysis(loops=(1, 2, 3), wind_speeds=WINDS)) for n in SUBCONDUCTORS}


def result(line: Line, analysis: Analysis) -> Result:
    """Analyse a line and drop the progress."""
    return finished(analyse(line, analysis))


def table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Return a table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def percent(value: float, reference: float) -> str:
    """Return the relative difference in per cent, with its sign."""
    return f"{100.0 * (value / reference - 1.0):+.2f}"
