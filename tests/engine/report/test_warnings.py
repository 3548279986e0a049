import math
from dataclasses import replace

import pytest

from engine.spec import (
    AerodynamicModel,
    AirflowSpoiler,
    Analysis,
    DetuningPendulum,
    IceSegment,
    Line,
    LongitudinalInertia,
    Model,
    Physics,
    PhysicsRequest,
    Spacer,
    Span,
    StaticTwist,
    Stretching,
    Support,
    Supports,
    with_physics,
    with_section,
)
from tests.builders import ICE_AT_40, run, source_line


def centred(line: Line) -> Line:
    """Return a line whose ice does not turn it."""
    return replace(line, ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0))


def test_heavy_devices_and_uneven_ice_carry_a_warning() -> None:
    line = centred(source_line(1))
    span_mass = 2.379 * 125.88
    light = replace(line, devices=(Spacer(60.0, 0.09 * span_mass, 0.0),))
    heavy = replace(line, devices=(Spacer(60.0, 0.11 * span_mass, 0.0),))
    uneven = replace(line, ice=replace(line.ice, segments=(IceSegment(0.0, 50.0, mass=3.0),)))
    analysis = Analysis(wind_speeds=(), models=(Model.HYBRID,))
    assert [len(run(x, analysis).warnings) for x in (line, light, heavy, uneven)] == [0, 0, 1, 1]


BOTH = Analysis(loops=(1, 2), wind_speeds=(2.0, 4.0, 6.0), finite_element_loops=(1, 2))


def test_an_ill_conditioned_mass_matrix_is_said_to_be_one() -> None:
    line = source_line(1)
    least = line.conductor.mass * (line.ice.eccentricity_y**2 + line.ice.eccentricity_z**2)

    def warnings(share: float) -> tuple[str, ...]:
        conductor = replace(line.conductor, polar_inertia=least * (1.0 + share))
        return run(replace(line, conductor=conductor), replace(BOTH, wind_speeds=())).warnings

    assert not any("ill-conditioned" in text for text in warnings(1e-3))
    (said,) = (text for text in warnings(1e-9) if "ill-conditioned" in text)
    assert "1.0e-09" in said
    assert not any("ill-conditioned" in text for text in run(source_line(2), BOTH).warnings)


def test_coefficients_at_rest_taken_from_the_line_are_named() -> None:
    line, known = source_line(1), replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0))
    segments = (IceSegment(0.0, 9.0, ICE_AT_40), IceSegment(9.0, 12.0, mass=2.4), IceSegment(12.0, 20.0, known))
    spoilers = (Spacer(60.0, 1.0, 0.0), AirflowSpoiler(30.0, 40.0, ICE_AT_40), AirflowSpoiler(40.0, 50.0, known))
    line = replace(line, ice=replace(line.ice, aerodynamics=known, segments=segments), devices=spoilers)
    asked = Analysis(wind_speeds=(), models=(Model.HYBRID,), aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
    (said,) = (text for text in run(line, asked).warnings if "at rest" in text)
    assert "ice.segments.0, devices.1 " in said
    published = replace(asked, aerodynamic_model=AerodynamicModel.PUBLISHED)
    assert not any("at rest" in text for text in run(line, published).warnings)


def twist_sentences(line: Line, static_twist: StaticTwist = StaticTwist.NEGLECTED) -> list[str]:
    analysis = Analysis(loops=(1,), wind_speeds=(4.0,), models=(Model.HYBRID,), static_twist=static_twist)
    return [text for text in run(line, analysis).warnings if "static_twist" in text]


def test_a_neglected_twist_of_more_than_five_degrees_carries_a_warning() -> None:
    pendulum = DetuningPendulum(62.94, 1.0, 0.3, 0.5)
    hung = replace(centred(source_line(1)), devices=(pendulum,))
    turn = run(hung, Analysis(loops=(1,), wind_speeds=(), models=(Model.HYBRID,), static_twist=StaticTwist.SOLVED))
    assert turn.static.twist_rad is not None
    assert 5.0 < abs(math.degrees(turn.static.twist_rad)) < 15.0
    (sentence,) = twist_sentences(hung)
    assert float(sentence.split("about ")[1].split(" ")[0]) == pytest.approx(
        abs(math.degrees(turn.static.twist_rad)), rel=0.15
    )
    (sentence,) = twist_sentences(source_line(1))
    assert "more than 5 degrees" in sentence
    assert twist_sentences(source_line(1), StaticTwist.SOLVED) == []
    assert twist_sentences(source_line(2)) == []
    assert twist_sentences(centred(source_line(1))) == []


def test_a_line_that_ice_would_turn_over_is_told_how_to_find_its_state() -> None:
    line = replace(source_line(1), span=replace(source_line(1).span, length=300.0))
    (sentence,) = twist_sentences(line)
    assert "exceeds the torsional stiffness" in sentence
    assert twist_sentences(line, StaticTwist.SOLVED) == []
    assert twist_sentences(line, StaticTwist.WHERE_LARGE) == []


def test_physics_that_the_data_kept_from_being_full_is_named() -> None:
    line, asked = source_line(2), Analysis(wind_speeds=(), models=(Model.HYBRID,))
    (said,) = run(line, with_physics(line, asked, PhysicsRequest())).warnings
    for part in (
        "ice.aerodynamics_at_rest is not given",
        "horizontal velocity",
        "longitudinal inertia",
        "measured table",
    ):
        assert part in said
    assert "by themselves" not in said
    rigid = with_section(line, Physics.SOURCE)
    (more,) = run(rigid, with_physics(rigid, asked, PhysicsRequest())).warnings
    assert "; that sub-conductors move along the span by themselves." in more
    single = PhysicsRequest(longitudinal_inertia=LongitudinalInertia.CONDENSED)
    (said,) = run(line, with_physics(line, asked, single)).warnings
    assert "longitudinal inertia" not in said
    assert run(line, with_physics(line, asked, PhysicsRequest(Physics.SOURCE))).warnings == ()


def test_a_span_that_relieves_in_more_shapes_than_one_points_at_the_finite_element_model() -> None:
    held = Support(dead_end=True)
    line = replace(source_line(1), span=Span(300.0, sag=9.0), supports=Supports(None, held, held))
    asked = Analysis(loops=(2,), wind_speeds=(), models=(Model.HYBRID,), stretching=Stretching.INCLUDED)
    (said,) = [text for text in run(line, asked).warnings if "relief coordinate" in text]
    assert "finite_element_loops 1, 2, 3 and 5 is better" in said
    for other in (replace(asked, loops=(1,)), replace(asked, stretching=Stretching.NEGLECTED)):
        assert not [text for text in run(line, other).warnings if "relief coordinate" in text]
    assert not [text for text in run(source_line(1), asked).warnings if "relief coordinate" in text]


def test_vertical_motion_that_is_partly_longitudinal_is_named() -> None:
    line = replace(source_line(2), span=Span(126.0, sag=0.04 * 126.0), supports=Supports(2e3))
    asked = Analysis(loops=(1, 2), wind_speeds=(), models=(Model.HYBRID,))
    (said,) = run(line, asked).warnings
    assert "loops (share of energy): 2 (17%)." in said
    assert "by about 10%" in said
    (said,) = run(line, replace(asked, longitudinal_inertia=LongitudinalInertia.CONDENSED)).warnings
    assert "overstates" not in said
    assert run(line, replace(asked, loops=(1,))).warnings == ()
