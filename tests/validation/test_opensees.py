"""The two-loop vertical frequency against OpenSees, from taut to slack spans. Theory section 12."""

from dataclasses import replace
from types import ModuleType

import pytest

from engine.spec import Analysis, Line, LongitudinalInertia, Model
from tests.builders import run, source_line

SAG_SHARES = (0.005, 0.01, 0.02, 0.04, 0.08)


def hung_span(sag_share: float, dead_ends: bool) -> Line:
    """Return a single conductor of 300 m whose mid-span sag is this share of the span."""
    line = source_line(1)
    span = replace(line.span, length=300.0, horizontal_tension=None, sag=300.0 * sag_share, elements=20)
    ends = {name: replace(getattr(line.supports, name), dead_end=dead_ends) for name in ("left", "right")}
    return replace(line, span=span, supports=replace(line.supports, **ends))


@pytest.mark.parametrize("dead_ends", [True, False], ids=["dead ends", "springs"])
@pytest.mark.parametrize("sag_share", SAG_SHARES)
def test_condensed_inertia_meets_it_within_a_thousandth(peer: ModuleType, sag_share: float, dead_ends: bool) -> None:
    line = hung_span(sag_share, dead_ends)
    asked = Analysis(
        loops=(2,), models=(Model.HYBRID,), wind_speeds=(), longitudinal_inertia=LongitudinalInertia.CONDENSED
    )
    result = run(line, asked)
    stiffness = result.static.longitudinal_stiffness_n_per_m
    end = float("inf") if stiffness is None else stiffness
    conductor = peer.Conductor(line.conductor.axial_rigidity, line.conductor.mass, result.static.horizontal_tension_n)
    expected = peer.vertical_frequency(conductor, peer.Section((300.0,), end_stiffness=(end, end)), loops=2)
    assert result.frequencies[0].vertical_hz == pytest.approx(expected, rel=1e-3)


def test_a_section_of_five_spans_is_that_of_the_theory_page(peer: ModuleType) -> None:
    line = source_line(1)
    conductor = peer.Conductor(line.conductor.axial_rigidity, line.conductor.mass, 40e3)
    section = peer.Section((350.0,) * 5, strings=(peer.InsulatorString(4.5, 2500.0),) * 4)
    _, modes = peer.natural_modes(conductor, section, 8, bars=60)
    expected = [0.15443, 0.16186, 0.17195, 0.18123, 0.18518, 0.18698, 0.18721, 0.18795]
    assert [mode.frequency for mode in modes] == pytest.approx(expected, rel=2e-4)
    assert [mode.direction for mode in modes] == ["horizontal"] * 5 + ["vertical"] * 3
