"""The source's Table 2: natural frequencies of one to four sub-conductors by both models."""

import json
from functools import lru_cache
from itertools import product
from pathlib import Path

import pytest

from engine.result import FrequencyRow
from engine.spec import Analysis, Model
from tests.builders import run, source_line

TABLE = json.loads((Path(__file__).parent / "table2.json").read_text())
# Table 2 prints three decimals of values from 0.44 Hz up, 0.1 % at the worst; the rest of the hybrid model's 1 % is
# what theory section 9 leaves open (area, length); the finite element rows are known to agree to 0.6 %.
TOLERANCE = {Model.HYBRID: 0.01, Model.FINITE_ELEMENT: 0.006}
DIRECTIONS = ("vertical_hz", "horizontal_hz", "torsional_hz")
ENTRIES = [
    (row["subconductors"], Model(row["model"]), int(loops), direction, value)
    for row in TABLE["rows"]
    for loops, values in row["loops"].items()
    for direction, value in zip(DIRECTIONS, values, strict=True)
]


@lru_cache
def frequencies(subconductors: int) -> tuple[FrequencyRow, ...]:
    """Return the frequency rows of a source line."""
    return run(source_line(subconductors), Analysis(loops=(1, 2, 3), wind_speeds=())).frequencies


def test_table_2_is_complete() -> None:
    keys = {entry[:4] for entry in ENTRIES}
    assert len(ENTRIES) == 72
    assert keys == set(product((1, 2, 3, 4), Model, (1, 2, 3), DIRECTIONS))


@pytest.mark.parametrize(("subconductors", "model", "loops", "direction", "printed"), ENTRIES)
def test_table_2(subconductors: int, model: Model, loops: int, direction: str, printed: float) -> None:
    rows = [r for r in frequencies(subconductors) if (r.model, r.loops) == (model, loops)]
    assert len(rows) == 1
    assert getattr(rows[0], direction) == pytest.approx(printed, rel=TOLERANCE[model])
