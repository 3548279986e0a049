"""Where the motion of a section is observed."""

import numpy as np
import pytest

from engine.result import Result
from engine.spec import Analysis, LongitudinalInertia, Model, Stretching
from tests.builders import THREE_SPANS, run, section_line

ASKED = Analysis(
    loops=(1, 2),
    models=(Model.HYBRID,),
    wind_speeds=(6.0,),
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)


def shares_of(result: Result) -> list[tuple[int, int | None, list[float]]]:
    """Return mode, span and shares of the cycles."""
    rows = (row for row in result.limit_cycles if row.kind == "periodic")
    return [(row.loops, row.span, [float(x) for x in (row.span_shares or "").split()]) for row in rows]


def test_a_motion_is_observed_in_the_span_that_moves_most() -> None:
    result = run(section_line(THREE_SPANS, subconductors=2), ASKED)
    moving = [row for row in result.limit_cycles if row.kind == "periodic"]
    assert {row.loops for row in moving} == {1, 2}
    for row, (_, span, shares) in zip(moving, shares_of(result), strict=True):
        assert span == 1 + int(np.argmax(shares))
        assert row.observed_at_m == pytest.approx(0.5 * THREE_SPANS[span - 1], rel=1e-6)
    still = [row for row in result.limit_cycles if row.kind == "equilibrium"]
    assert all(row.span is None and row.span_shares is None for row in still)


def test_the_other_order_of_the_spans_mirrors_the_motion() -> None:
    one = run(section_line(THREE_SPANS, subconductors=2, interest=1), ASKED)
    other = run(section_line(THREE_SPANS[::-1], subconductors=2, interest=3), ASKED)
    found, mirrored = shares_of(one), shares_of(other)
    assert found
    for (mode, span, shares), (its_mode, its_span, its_shares) in zip(found, mirrored, strict=True):
        assert (mode, span) == (its_mode, 4 - (its_span or 0))
        assert shares == pytest.approx(its_shares[::-1], abs=2e-4)
    amplitudes = [[row.vertical_m for row in result.limit_cycles] for result in (one, other)]
    assert amplitudes[0] == pytest.approx(amplitudes[1], rel=1e-5)


def test_equal_spans_move_symmetrically() -> None:
    result = run(section_line(subconductors=2), ASKED)
    assert shares_of(result)
    for _, _, shares in shares_of(result):
        assert shares == pytest.approx(shares[::-1], abs=2e-4)
    by_span = {row.span: row.largest_horizontal_n for row in result.tensions if row.loops == 1}
    assert set(by_span) == {1, 2, 3, 4, 5}
    assert by_span[1] == pytest.approx(by_span[5], rel=1e-6)
    assert by_span[2] == pytest.approx(by_span[4], rel=1e-6)
