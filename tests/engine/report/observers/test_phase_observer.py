"""Where motions of tied phases are observed."""

import pytest

from engine.spec import Analysis, InterphaseSpacer
from tests.builders import phases_line, run


def test_a_motion_is_observed_where_its_shape_is_widest() -> None:
    asked = Analysis(loops=(1,), finite_element_loops=(1,), wind_speeds=(6.0,))
    result = run(phases_line(InterphaseSpacer(62.94, 0.0, ("this", "top"))), asked)
    alike, against = (row for row in result.limit_cycles if row.kind == "periodic")
    assert alike.observed_at_m == pytest.approx(62.94)
    # the spacer holds the middle: the widest place is that of half the span, to the nearest node of the elements
    assert against.observed_at_m == pytest.approx(0.25 * 125.88, abs=0.05 * 125.88)
    assert (against.vertical_m or 0.0) > 0.01
    at_rest = next(row for row in result.limit_cycles if row.kind == "equilibrium")
    assert at_rest.observed_at_m == pytest.approx(62.94)
    assert at_rest.phase is None
