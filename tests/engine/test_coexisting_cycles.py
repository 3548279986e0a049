"""Stable cycles that coexist are found from one wind speed alone, and so from any set of wind speeds."""

from dataclasses import replace

import numpy as np
import pytest

from engine.result import LimitCycleRow
from engine.spec import Line, Model, Span
from tests.builders import only, run, source_line, stable_cycles

LIGHT = 0.0308


def stable_rows(line: Line, loops: int, *winds: float) -> list[list[LimitCycleRow]]:
    """Return the rows of stable cycles of the hybrid model at each wind speed."""
    result = run(line, only(Model.HYBRID, loops=(loops,), wind_speeds=winds))
    return [stable_cycles(result, loops=loops, wind_speed=wind) for wind in winds]


def with_light_damping(subconductors: int, length: float, tension: float) -> Line:
    """Return a source line of other span with a tenth of its torsional damping."""
    line = source_line(subconductors)
    damping = replace(line.damping, torsional_ratio=LIGHT)
    return replace(line, damping=damping, span=Span(length, horizontal_tension=tension))


# The figures are those at which direct integration stays. That of the triple was read at the first antinode, 1.637 m up
# and down; it is largest sideways in the middle, where its vertical mode has 0.966 of the first antinode.
@pytest.mark.parametrize(
    ("line", "loops", "wind", "expected"),
    [
        (source_line(1), 3, 20.0, [(0.017, 0.256), (2.50, 1.431)]),
        (with_light_damping(4, 234.8, 38_621.0), 2, 9.83, [(0.099, 2.455), (1.073, 3.586)]),
        (with_light_damping(3, 356.4, 19_391.0), 3, 19.37, [(1.637 * 0.966, 3.755)]),
    ],
    ids=["single", "quad", "triple"],
)
def test_stable_cycles_at_one_wind_speed(
    line: Line, loops: int, wind: float, expected: list[tuple[float, float]]
) -> None:
    (rows,) = stable_rows(line, loops, wind)
    found = sorted((row.vertical_m or 0.0, row.horizontal_m or 0.0) for row in rows)
    assert len(found) == len(expected)
    for own, other in zip(found, expected, strict=True):
        assert own == pytest.approx(other, rel=0.01, abs=5e-4)


def test_one_wind_speed_gives_what_many_give() -> None:
    winds = (14.0, 16.0, 18.0, 20.0)
    for wind, rows in zip(winds, stable_rows(source_line(1), 3, *winds), strict=True):
        (own,) = stable_rows(source_line(1), 3, wind)
        alone, among = (np.sort([row.vertical_m or 0.0 for row in table]) for table in (own, rows))
        assert alone == pytest.approx(among, rel=1e-4)
