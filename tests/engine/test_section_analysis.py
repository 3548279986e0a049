"""Sections as a whole: their results beside those of single spans, and what they do not have."""

from dataclasses import replace

import pytest

from engine.outcome import InvalidSpec
from engine.result import Result
from engine.spec import (
    AerodynamicModel,
    Analysis,
    Closure,
    LongitudinalInertia,
    LoopCompetition,
    Model,
    StaticTwist,
    Stretching,
    check_compatible,
)
from tests.builders import STIFF_STRINGS, THREE_SPANS, run, section_line
from tests.engine.synthetic_table import with_table

SOURCE = Analysis(loops=(3,), models=(Model.HYBRID,), wind_speeds=(4.0, 6.0))
FULL = replace(
    SOURCE,
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
)


def known_at_rest(result_of: Analysis) -> tuple[Result, Result]:
    """Return the results of a section whose strings cannot swing, and of its longest span between dead ends.

    The third vertical mode of the section is that of one loop of this span.
    """
    line = section_line(THREE_SPANS, subconductors=2, interest=3, string=STIFF_STRINGS)
    line = replace(line, ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))))
    end = replace(line.supports.left, dead_end=True)
    alone = replace(line, section=None, supports=replace(line.supports, left=end, right=end))
    return run(line, result_of), run(alone, replace(result_of, loops=(1,)))


@pytest.mark.parametrize("analysis", [SOURCE, FULL], ids=["source", "full"])
def test_a_span_between_strings_that_cannot_swing_moves_as_a_single_span(analysis: Analysis) -> None:
    section, single = known_at_rest(analysis)
    for name, columns in (
        ("frequencies", ("vertical_hz", "torsional_hz")),
        ("critical_wind_speeds", ("wind_speed_m_per_s", "frequency_hz", "crossing")),
        ("limit_cycles", ("vertical_m", "horizontal_m", "torsional_rad", "frequency_hz", "stability", "observed_at_m")),
        ("bifurcations", ("type", "wind_speed_m_per_s")),
    ):
        found, expected = getattr(section, name), getattr(single, name)
        assert len(found) == len(expected) > 0
        for row, other in zip(found, expected, strict=True):
            for column in columns:
                own, value = getattr(row, column), getattr(other, column)
                if (name, column) == ("frequencies", "torsional_hz"):
                    continue  # of the third torsional mode of the section, which is that of another span
                assert own == (pytest.approx(value, rel=1e-5) if isinstance(value, float) else value), (name, column)
    if analysis is FULL:
        own = [row for row in section.tensions if row.span == 3]
        assert [row.largest_horizontal_n for row in own] == pytest.approx(
            [row.largest_horizontal_n for row in single.tensions], rel=1e-6
        )
    assert section.physics[0].neighbours == "moving"
    assert single.physics[0].neighbours == "dead_ends"


def test_the_finite_element_model_moves_the_modes_together() -> None:
    line = section_line(THREE_SPANS, subconductors=2)
    asked = replace(SOURCE, loops=(1, 2), models=(Model.FINITE_ELEMENT,), finite_element_loops=(1, 2), wind_speeds=())
    result = run(line, asked)
    assert [(row.model, row.loops) for row in result.frequencies] == [("finite_element", 1), ("finite_element", 2)]
    assert result.frequencies[0].vertical_hz == pytest.approx(0.18518, rel=5e-3)
    assert {row.direction for row in result.section_modes} == {"vertical", "horizontal", "torsional"}
    assert result.critical_wind_speeds
    assert all(row.span in (1, 2, 3) for row in result.critical_wind_speeds)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"closure": Closure.PUBLISHED}, "closure"),
        ({"aerodynamic_model": AerodynamicModel.TABLE}, "aerodynamic_model"),
        ({"loop_competition": LoopCompetition.CHECKED}, "loop_competition"),
    ],
)
def test_what_a_section_does_not_have_is_refused(change: dict[str, object], field: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        check_compatible(section_line(), replace(SOURCE, **change))  # type: ignore[arg-type]
    assert field in [fault.field for fault in caught.value.faults]
    assert any("section" in fault.rule for fault in caught.value.faults)


def test_a_table_whose_equilibria_are_not_computed_has_a_warning() -> None:
    line = with_table(section_line(THREE_SPANS, subconductors=2), 20.0)
    asked = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(), static_twist=StaticTwist.SOLVED)
    result = run(line, asked)
    assert result.static.twist_rad is not None
    assert any("static equilibria" in text for text in result.warnings)
    assert not result.static_equilibria
