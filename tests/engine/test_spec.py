"""Every rule of a specification names field, value and rule, and all broken rules are told at once."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from engine.outcome import Fault, InvalidSpec, require
from engine.spec import (
    AerodynamicModel,
    Aerodynamics,
    AirflowSpoiler,
    Analysis,
    BlowOut,
    Bundle,
    Closure,
    Conductor,
    CrossSection,
    Damping,
    DetuningPendulum,
    Ice,
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
    Uncertainty,
    Wind,
    Yoke,
    check_compatible,
    ice_properties,
    with_physics,
    with_section,
)
from tests.builders import ICE_AT_40, source_line

NAN, INF = math.nan, math.inf
CONDUCTOR = (0.0286, 2.8e7, 101.0, 2.379, 3.3e-4)
LINE = source_line(2)


def conductor(index: int, value: float) -> Callable[[], Conductor]:
    """Return a maker of the source's conductor with one number changed."""
    numbers = [*CONDUCTOR[:index], value, *CONDUCTOR[index + 1 :]]
    return lambda: Conductor(*numbers)


def with_devices(*devices: Any) -> Callable[[], Line]:
    """Return a maker of a line with devices."""
    return lambda: replace(LINE, devices=devices)


def segments(*values: IceSegment) -> Callable[[], Ice]:
    """Return a maker of ice with segments."""
    return lambda: Ice(ICE_AT_40, segments=values)


NAMES = ("diameter", "axial_rigidity", "torsional_rigidity", "mass", "polar_inertia")
# what is made, the field at fault, a word of the rule
RULES: list[tuple[Callable[[], object], str, str]] = [
    *(
        (conductor(i, bad), f"conductor.{n}", "greater than zero")
        for i, n in enumerate(NAMES)
        for bad in (0.0, -1.0, NAN, INF)
    ),
    (lambda: Conductor(*CONDUCTOR, INF), "conductor.axial_torsional_coupling", "finite"),
    (lambda: Conductor(*CONDUCTOR, 6e4), "conductor.axial_torsional_coupling", "strain energy"),
    (lambda: Bundle(()), "bundle.positions", "must hold"),
    (lambda: Bundle(((0.0, NAN),)), "bundle.positions.0.1", "finite"),
    (lambda: Bundle(((0.1, 0.2), (0.1, 0.2))), "bundle.positions", "distinct"),
    (lambda: Bundle.regular(0, 0.2, 0.0), "bundle.subconductors", "at least 1"),
    (lambda: Bundle.regular(1, 0.2, 0.0), "bundle.radius", "must be 0"),
    (lambda: Bundle.regular(2, 0.0, 0.0), "bundle.radius", "greater than zero"),
    (lambda: Bundle.regular(2, 0.2, NAN), "bundle.orientation", "finite"),
    (lambda: Span(0.0, horizontal_tension=1.0), "span.length", "greater than zero"),
    (lambda: Span(100.0), "span", "exactly one"),
    (lambda: Span(100.0, horizontal_tension=1.0, sag=1.0), "span", "exactly one"),
    (lambda: Span(100.0, horizontal_tension=NAN), "span.horizontal_tension", "greater than zero"),
    (lambda: Span(100.0, catenary_parameter=-5.0), "span.catenary_parameter", "greater than zero"),
    (lambda: Span(100.0, sag=0.0), "span.sag", "greater than zero"),
    (lambda: Span(100.0, sag=1.0, elements=1), "span.elements", "at least 2"),
    (lambda: Span(100.0, sag=1.0, level_difference=NAN), "span.level_difference", "finite"),
    (lambda: Span(100.0, sag=1.0, level_difference=-101.0), "span.level_difference", "must not exceed"),
    (lambda: Support(adjacent_span=0.0), "adjacent_span", "greater than zero"),
    (lambda: Support(insulator_length=-1.0), "insulator_length", "greater than zero"),
    (lambda: Support(insulator_weight=-1.0), "insulator_weight", "at least zero"),
    (lambda: Supports(longitudinal_stiffness=0.0), "supports.longitudinal_stiffness", "greater than zero"),
    (lambda: Aerodynamics((NAN, 0.0, 0.0), (0.0,) * 3, (0.0,) * 3), "vertical.0", "finite"),
    (lambda: Aerodynamics((0.0,) * 3, (0.0,) * 3, (0.0, 0.0, INF)), "torsional.2", "finite"),
    (lambda: replace(ICE_AT_40, at_rest=(0.0, NAN, 0.0)), "at_rest.1", "finite"),
    (lambda: replace(ICE_AT_40, fitted_range=0.0), "fitted_range", "greater than zero"),
    (lambda: IceSegment(-1.0, 2.0), "start", "at least zero"),
    (lambda: IceSegment(3.0, 2.0), "stop", "greater than the start"),
    (lambda: IceSegment(1.0, NAN), "stop", "finite"),
    (lambda: IceSegment(1.0, 2.0, mass=0.0), "mass", "greater than zero"),
    (lambda: IceSegment(1.0, 2.0, eccentricity_z=NAN), "eccentricity_z", "finite"),
    (lambda: Ice(ICE_AT_40, eccentricity_y=INF), "ice.eccentricity_y", "finite"),
    (segments(IceSegment(0.0, 5.0), IceSegment(4.0, 6.0)), "ice.segments.1", "overlap"),
    (segments(IceSegment(4.0, 6.0), IceSegment(0.0, 5.0)), "ice.segments.0", "overlap"),
    (lambda: BlowOut(-1.0, 1.0), "wind.blow_out.wind_speed", "at least zero"),
    (lambda: BlowOut(1.0, NAN), "wind.blow_out.drag_coefficient", "at least zero"),
    (lambda: Wind(yaw=-1.6), "wind.yaw", "right angle"),
    (lambda: replace(LINE, wind=Wind(blow_out=BlowOut(10.0))), "wind.blow_out.drag_coefficient", "at_rest"),
    (lambda: Wind(0.0), "wind.air_density", "greater than zero"),
    (lambda: Wind(1.2, ((0.0, 1.0), (5.0, 0.0))), "wind.profile.1.factor", "greater than zero"),
    (lambda: Wind(1.2, ((-1.0, 1.0),)), "wind.profile.0.position", "at least zero"),
    (lambda: Wind(1.2, ((5.0, 1.0), (5.0, 2.0))), "wind.profile", "rising order"),
    (lambda: Damping(0.0, 0.1, 0.1), "damping.vertical_ratio", "greater than zero"),
    (lambda: Damping(0.1, 1.0, 0.1), "damping.horizontal_ratio", "below 1"),
    (lambda: Damping(0.1, 0.1, NAN), "damping.torsional_ratio", "greater than zero"),
    (lambda: Spacer(-1.0, 1.0, 1.0), "position", "at least zero"),
    (lambda: Spacer(1.0, NAN, 1.0), "mass", "at least zero"),
    (lambda: Spacer(1.0, 1.0, -1.0), "polar_inertia", "at least zero"),
    (lambda: DetuningPendulum(1.0, 1.0, 0.0), "arm", "greater than zero"),
    (lambda: DetuningPendulum(1.0, 1.0, 1.0, INF), "angle", "finite"),
    (lambda: AirflowSpoiler(5.0, 4.0, ICE_AT_40), "stop", "greater than the start"),
    (lambda: AirflowSpoiler(1.0, 4.0, ICE_AT_40, -1.0), "mass", "at least zero"),
    (with_devices(Spacer(126.0, 1.0, 1.0)), "devices.0.position", "on the span"),
    (with_devices(AirflowSpoiler(0.0, 130.0, ICE_AT_40)), "devices.0.stop", "on the span"),
    (
        with_devices(AirflowSpoiler(0.0, 10.0, ICE_AT_40), AirflowSpoiler(9.0, 12.0, ICE_AT_40)),
        "devices.1",
        "overlap",
    ),
    (
        with_devices(Spacer(1.0, 1.0, 1.0), AirflowSpoiler(9.0, 12.0, ICE_AT_40), AirflowSpoiler(0.0, 10.0, ICE_AT_40)),
        "devices.1",
        "overlap",
    ),
    (lambda: replace(LINE, ice=segments(IceSegment(100.0, 140.0))()), "ice.segments.0.stop", "on the span"),
    (lambda: replace(LINE, wind=Wind(1.2, ((200.0, 1.0),))), "wind.profile.0.position", "on the span"),
    (lambda: replace(LINE, ice=Ice(ICE_AT_40, 0.02, 0.0)), "ice.eccentricity_y", "polar inertia"),
    (
        lambda: replace(LINE, ice=segments(IceSegment(0.0, 10.0, eccentricity_z=0.02))()),
        "ice.segments.0.eccentricity_y",
        "polar inertia",
    ),
    (lambda: Analysis(loops=()), "loops", "whole numbers"),
    (lambda: Analysis(loops=(1, 1)), "loops", "distinct"),
    (lambda: Analysis(finite_element_loops=(0,)), "finite_element_loops", "from 1"),
    (lambda: Analysis(models=()), "models", "must name"),
    (lambda: Analysis(wind_speeds=(4.0, -1.0)), "wind_speeds.1", "greater than zero"),
    (lambda: Analysis(critical_wind_limit=INF), "critical_wind_limit", "greater than zero"),
    (lambda: Analysis(harmonics=0), "harmonics", "from 1 to 20"),
    (lambda: Analysis(harmonics=21), "harmonics", "from 1 to 20"),
    (lambda: Uncertainty(samples=-1), "uncertainty.samples", "from 0 to 16384"),
    (lambda: Uncertainty(samples=16_385), "uncertainty.samples", "from 0 to 16384"),
    (lambda: Uncertainty(seed=-1), "uncertainty.seed", "negative"),
    (
        lambda: Analysis(closure=Closure.PUBLISHED, aerodynamic_model=AerodynamicModel.RELATIVE_WIND),
        "closure",
        "exact",
    ),
]


@pytest.mark.parametrize(("make", "field", "word"), RULES)
def test_broken_rule_names_field_value_and_rule(make: Callable[[], object], field: str, word: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        make()
    matching = [f for f in caught.value.faults if f.field.endswith(field)]
    assert matching, caught.value
    assert any(word in fault.rule for fault in matching)
    assert all(str(fault) in str(caught.value) and repr(fault.value) in str(fault) for fault in matching)


def test_all_faults_are_told_at_once() -> None:
    with pytest.raises(InvalidSpec) as caught:
        Conductor(-1.0, 0.0, NAN, 1.0, 1.0, INF)
    fields = [fault.field for fault in caught.value.faults]
    assert fields[:3] == [f"conductor.{n}" for n in NAMES[:3]]
    assert "conductor.axial_torsional_coupling" in fields
    with pytest.raises(InvalidSpec) as caught:
        with_devices(Spacer(200.0, 1.0, 1.0), Spacer(1.0, 1.0, 1.0), Spacer(300.0, 1.0, 1.0))()
    assert [fault.field for fault in caught.value.faults] == ["devices.0.position", "devices.2.position"]


def test_value_at_fault_is_carried() -> None:
    with pytest.raises(InvalidSpec) as caught:
        Span(-3.0, sag=1.0)
    (fault,) = caught.value.faults
    assert (fault.field, fault.value) == ("span.length", -3.0)


def test_require_raises_only_what_is_there() -> None:
    require(None, None)
    first, second = Fault("a", 1, "must be 2"), Fault("b", 3, "must be 4")
    with pytest.raises(InvalidSpec, match=r"a must be 2, got 1; b must be 4, got 3") as caught:
        require(None, first, None, second)
    assert caught.value.faults == (first, second)


def test_line_and_analysis_must_fit() -> None:
    with pytest.raises(InvalidSpec, match="number of elements"):
        check_compatible(LINE, Analysis(loops=(11,)))
    profile = replace(LINE, wind=Wind(1.2, ((0.0, 1.0),)))
    with pytest.raises(InvalidSpec, match="wind profile"):
        check_compatible(profile, Analysis(closure=Closure.PUBLISHED))
    relative = Analysis(aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
    with pytest.raises(InvalidSpec) as caught:
        check_compatible(LINE, relative)
    assert [fault.field for fault in caught.value.faults] == ["ice.aerodynamics_at_rest"]
    partly = Ice(replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0)), segments=(IceSegment(0.0, 1.0, ICE_AT_40),))
    check_compatible(replace(LINE, ice=partly, devices=(AirflowSpoiler(2.0, 3.0, ICE_AT_40),)), relative)
    check_compatible(LINE, Analysis())


KNOWN = replace(LINE, ice=Ice(replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0))))
SOURCE = (
    AerodynamicModel.PUBLISHED,
    LongitudinalInertia.NEGLECTED,
    Stretching.NEGLECTED,
    StaticTwist.NEGLECTED,
)
FULL = (
    AerodynamicModel.RELATIVE_WIND,
    LongitudinalInertia.CONDENSED,
    Stretching.INCLUDED,
    StaticTwist.WHERE_LARGE,
)


@pytest.mark.parametrize(
    ("line", "asked", "physics", "options"),
    [
        (KNOWN, PhysicsRequest(), Physics.FULL, FULL),
        (LINE, PhysicsRequest(), Physics.SOURCE, SOURCE),
        (KNOWN, PhysicsRequest(Physics.SOURCE), Physics.SOURCE, SOURCE),
        (LINE, PhysicsRequest(Physics.FULL), Physics.FULL, FULL),
        (KNOWN, PhysicsRequest(Physics.SOURCE, FULL[0]), Physics.SOURCE, (FULL[0], *SOURCE[1:])),
        (LINE, PhysicsRequest(None, None, FULL[1]), Physics.SOURCE, (SOURCE[0], FULL[1], *SOURCE[2:])),
        (KNOWN, PhysicsRequest(stretching=SOURCE[2]), Physics.FULL, (*FULL[:2], SOURCE[2], FULL[3])),
        (KNOWN, PhysicsRequest(static_twist=SOURCE[3]), Physics.FULL, (*FULL[:3], SOURCE[3])),
    ],
)
def test_physics_is_that_asked_for_or_that_of_the_data(
    line: Line, asked: PhysicsRequest, physics: Physics, options: tuple[object, ...]
) -> None:
    found = with_physics(line, Analysis(loops=(2,)), asked)
    assert found.physics is physics
    chosen = (found.aerodynamic_model, found.longitudinal_inertia, found.stretching, found.static_twist)
    assert chosen == options
    assert found.loops == (2,)
    unasked = asked.physics is None and line is LINE
    assert found.lacks == ("ice.aerodynamics_at_rest" if unasked else None)


@pytest.mark.parametrize(
    ("physics", "section"), [(Physics.SOURCE, CrossSection.RIGID), (Physics.FULL, CrossSection.FREE)]
)
def test_bundles_that_do_not_say_how_they_move_do_as_physics_has_it(physics: Physics, section: CrossSection) -> None:
    twin = replace(LINE, bundle=Bundle.regular(2, 0.2, 0.0))
    found = with_section(twin, physics)
    assert found == replace(twin, bundle=replace(twin.bundle, section=section))
    for said in CrossSection:
        line = replace(twin, bundle=replace(twin.bundle, section=said))
        assert with_section(line, physics) is line
    single = replace(LINE, bundle=Bundle())
    assert with_section(single, physics) is single


def test_published_closure_belongs_to_the_source() -> None:
    published = Analysis(closure=Closure.PUBLISHED)
    found = with_physics(LINE, published, PhysicsRequest())
    assert (found.physics, found.lacks) == (Physics.SOURCE, None)
    with pytest.raises(InvalidSpec, match="closure must be exact"):
        with_physics(KNOWN, published, PhysicsRequest(Physics.FULL))


def test_regular_bundle_follows_eq_3() -> None:
    twin = Bundle.regular(2, 0.2, math.pi / 2.0)
    assert twin.positions[0] == pytest.approx((0.0, 0.2), abs=1e-15)  # clockwise from straight up: downwind
    assert twin.positions[1] == pytest.approx((0.0, -0.2), abs=1e-15)
    assert Bundle.regular(1, 0.0, 3.0).positions == ((0.0, 0.0),)


def test_segments_override_only_what_they_name() -> None:
    segment = IceSegment(0.0, 5.0, eccentricity_z=1e-3)
    assert ice_properties(LINE, segment) == (LINE.ice.eccentricity_y, 1e-3, 2.379)
    assert ice_properties(LINE, IceSegment(0.0, 5.0, mass=3.0))[2] == 3.0
    assert ice_properties(LINE, LINE.ice) == (2.05e-3, -0.63e-3, 2.379)


def test_finite_element_loops_are_bounded_where_motions_are_asked_for() -> None:
    many = (1, 2, 3, 4, 5, 6, 7)
    with pytest.raises(InvalidSpec, match="finite_element_loops must not make more than 6"):
        Analysis(finite_element_loops=many)
    assert Analysis(finite_element_loops=many, models=(Model.HYBRID,)).finite_element_loops == many
    assert Analysis(loops=many, finite_element_loops=()).loops == many
    with pytest.raises(InvalidSpec, match=r"with loops \(4, 5, 6, 7\); it has these values unless others are given"):
        Analysis(loops=(4, 5, 6, 7))


@pytest.mark.parametrize(
    ("end", "held"),
    [
        (Support(), True),
        (Support(dead_end=True), True),
        (Support(dead_end=True, insulator_length=2.0), True),  # a dead end has no suspension string
        (Support(insulator_length=2.0), False),
        (Support(yoke=Yoke.FREE), False),
        (Support(dead_end=True, yoke=Yoke.FREE), False),
        (Support(insulator_length=2.0, yoke=Yoke.HELD), True),
    ],
)
def test_yokes_are_held_but_at_strings_unless_said_otherwise(end: Support, held: bool) -> None:
    assert end.holds_differences is held


def test_loops_that_no_model_uses_are_not_held_against_the_elements() -> None:
    short = replace(LINE, span=replace(LINE.span, elements=2))
    check_compatible(short, Analysis(loops=(1,), models=(Model.HYBRID,)))
    with pytest.raises(InvalidSpec) as caught:
        check_compatible(short, Analysis(loops=(1,)))
    assert [(fault.field, fault.value) for fault in caught.value.faults] == [("finite_element_loops", 3)]
