"""The relative wind on the source's twin bundle: theory section 5, figures of docs/validation.md."""

from dataclasses import replace

import pytest

from benchmarks.validation.relative_wind import unexpanded_rows
from engine.spec import AerodynamicModel, Analysis, Line, Model
from tests.builders import run, source_line, stable_cycles

RELATIVE = Analysis(
    loops=(2,), wind_speeds=(6.0,), finite_element_loops=(2,), aerodynamic_model=AerodynamicModel.RELATIVE_WIND
)


def twin(drag: float = 1.0) -> Line:
    line = source_line(2)
    aerodynamics = replace(line.ice.aerodynamics, at_rest=(0.0, drag, 0.0))
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


def test_drag_takes_nine_tenths_of_the_horizontal_motion_of_two_loops() -> None:
    published = run(twin(), replace(RELATIVE, aerodynamic_model=AerodynamicModel.PUBLISHED, models=(Model.HYBRID,)))
    relative = run(twin(), RELATIVE)
    (before,) = stable_cycles(published, loops=2, wind_speed=6.0)
    (after,) = stable_cycles(relative, loops=2, wind_speed=6.0)
    assert before.horizontal_m == pytest.approx(0.948, rel=0.01)
    assert after.horizontal_m == pytest.approx(0.0651, rel=0.01)
    assert after.vertical_m == pytest.approx(0.1528, rel=0.01)
    onset = {row.model: row.wind_speed_m_per_s for row in relative.critical_wind_speeds if row.crossing == "onset"}
    assert onset[Model.HYBRID] == pytest.approx(2.429, rel=0.005)


def test_both_models_agree_where_drag_damps_the_resonance() -> None:
    """Without it 0.1 % of detuning changes the horizontal amplitude by tens of percent (theory section 7.4)."""
    result = run(twin(), RELATIVE)
    rows = [stable_cycles(result, loops=2, wind_speed=6.0, model=model)[0] for model in Model]
    assert rows[0].vertical_m == pytest.approx(rows[1].vertical_m, rel=0.02)
    assert rows[0].horizontal_m == pytest.approx(rows[1].horizontal_m, rel=0.05)


def test_the_cycles_of_the_expanded_load_are_those_of_the_load_itself() -> None:
    """Direct integration of the load that is not expanded, begun on each cycle, stays on it within 0.1 %."""
    rows = list(unexpanded_rows(2, cycles=60))
    assert [row[:3] for row in rows] == [[2, 1, "4"], [2, 1, "6"], [2, 2, "4"], [2, 2, "6"]]
    assert all(abs(float(str(row[6]))) < 0.1 for row in rows)
