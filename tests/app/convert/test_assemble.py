import math
from dataclasses import fields
from enum import Enum
from typing import Any, get_args

import pytest

from app import schemas
from app.convert import parts
from app.convert.assemble import SoundParts, gather
from app.reference.source_lines import example
from engine import spec
from tests.app.lines import COEFFICIENTS, FULL_LINE, changed, faults


def built(line: dict[str, Any], analysis: dict[str, Any] | None = None) -> tuple[spec.Line, spec.Analysis]:
    made, asked, wrong = gather(
        SoundParts.of(schemas.Line.model_validate(line)), schemas.Analysis.model_validate(analysis or {})
    )
    assert wrong == []
    assert made is not None
    return made, asked


def test_every_field_of_the_contract_arrives_in_the_engine_in_its_unit() -> None:
    line, _ = built(FULL_LINE)
    vertical, horizontal, torsional = (tuple(COEFFICIENTS[n]) for n in ("vertical", "horizontal", "torsional"))
    own = spec.Aerodynamics(vertical, horizontal, torsional, at_rest=(0.1, 1.0, 0.2))
    on_segment = spec.Aerodynamics(vertical, horizontal, torsional, at_rest=(0.3, 1.1, 0.4))
    assert line == spec.Line(
        conductor=spec.Conductor(0.0286, 28418105.8, 101.0, 2.379, 3.334e-4, 0.5, 140000.0),
        bundle=spec.Bundle.regular(2, 0.2355, math.pi / 2, spec.CrossSection.FREE),
        span=spec.Span(125.88, horizontal_tension=30000.0, elements=12, level_difference=3.0),
        ice=spec.Ice(own, 2.05e-3, -0.63e-3, (spec.IceSegment(0.0, 62.94, on_segment, 1e-3, None, 2.3),)),
        wind=spec.Wind(1.2, ((0.0, 0.7), (125.88, 1.3)), spec.BlowOut(10.0, 1.1), math.pi / 6),
        damping=spec.Damping(0.000515, 0.0006, 0.308, spec.DampingModel.CONSTANT_RATIO),
        supports=spec.Supports(
            None, spec.Support(dead_end=True, yoke=spec.Yoke.FREE), spec.Support(False, 99.0, 2.0, 300.0)
        ),
        devices=(
            spec.Spacer(25.0, 6.5, 0.4),
            spec.DetuningPendulum(62.94, 12.0, 0.35, math.pi / 6),
            spec.AirflowSpoiler(30.0, 60.0, spec.Aerodynamics(vertical, horizontal, torsional), 0.3),
        ),
        climate=spec.Climate(
            azimuth=math.pi / 2,
            sectors=(
                spec.WindSector(
                    math.pi / 4, 0.25, spec.Ranged(2.0, 1.8, 2.2), spec.Ranged(6.0, 5.0, 7.0), math.radians(30.0)
                ),
                spec.WindSector(math.pi, 0.75, spec.Ranged(1.6), spec.Ranged(4.0), 0.0),
            ),
            icing=(
                spec.Icing("glaze", 0.012, hours=spec.Ranged(40.0, 20.0, 80.0)),
                spec.Icing(
                    "wet snow",
                    events=spec.Ranged(2.0, 1.0, 4.0),
                    event_hours=spec.Ranged(20.0, 10.0, 40.0),
                    persistence=spec.Ranged(6.0, 1.0, 12.0),
                ),
            ),
        ),
    )


def test_blow_out_may_follow_the_wind_with_the_drag_at_rest() -> None:
    line, _ = built(changed("wind.blow_out", {"wind_speed_m_per_s": None}))
    assert line.wind.blow_out == spec.BlowOut(None, None)
    assert line.follows_wind


def test_a_torsional_damper_arrives_and_its_damping_may_be_studied() -> None:
    damper = {"type": "torsional_damper", "position_m": 62.94, "mass_kg": 20.0, "polar_inertia_kg_m2": 0.8}
    line = changed("devices", [{**damper, "damping_n_m_s": 15.0}])
    assert built(line)[0].devices == (spec.TorsionalDamper(62.94, 20.0, 0.8, 15.0),)
    axes = [{"parameter": "devices.0.damping_n_m_s", "values": [0.0, 30.0]}]
    assert faults({"line": line, "study": {"axes": axes}}) == []
    refused = faults({"line": changed("devices.0.damping_n_m_s", -1.0, line)})
    assert [fault.pointer for fault in refused] == ["/line/devices/0/damping_n_m_s"]


def test_every_field_of_an_analysis_arrives_in_the_engine() -> None:
    _, analysis = built(
        example("c11-twin"),
        {
            "loops": [2],
            "models": ["finite_element"],
            "wind_speeds_m_per_s": {"start": 4.0, "stop": 6.0, "count": 3},
            "closure": "published",
            "longitudinal_inertia": "condensed",
            "critical_wind_limit_m_per_s": 12.0,
            "harmonics": 7,
            "finite_element_loops": [2, 3],
            "risk": False,
        },
    )
    assert analysis == spec.Analysis(
        loops=(2,),
        models=(spec.Model.FINITE_ELEMENT,),
        wind_speeds=(4.0, 5.0, 6.0),
        closure=spec.Closure.PUBLISHED,
        longitudinal_inertia=spec.LongitudinalInertia.CONDENSED,
        critical_wind_limit=12.0,
        harmonics=7,
        finite_element_loops=(2, 3),
        risk=False,
    )


def circle(*, last: float = 0.0, without: tuple[float, float] = (0.0, 0.0)) -> dict[str, Any]:
    """Return a table of the full circle, with another lift in its last row, or without the rows between two angles."""
    rows: list[dict[str, float]] = [
        {"angle_deg": a, "lift": 0.0, "drag": 1.0, "moment": 0.0}
        for a in (10.0 * k for k in range(-18, 19))
        if not without[0] < a < without[1]
    ]
    rows[-1]["lift"] = last
    return {"table": rows, "static_angle_deg": 0.0, "half_range_deg": 45.0}


@pytest.mark.parametrize(
    ("table", "field"),
    [
        (circle(last=0.3), "ice.aerodynamics.table.36.lift"),
        (circle(without=(60.0, 90.0)), "ice.aerodynamics.table.25.angle"),
        (None, "ice.aerodynamics"),
    ],
)
def test_the_table_model_names_the_row_that_keeps_a_table_from_being_a_curve(
    table: dict[str, Any] | None, field: str
) -> None:
    line = changed("wind", {})
    line = line if table is None else changed("ice", {"aerodynamics": table}, line)
    parts_of_line = SoundParts.of(schemas.Line.model_validate(line))
    _, _, wrong = gather(parts_of_line, schemas.Analysis.model_validate({"aerodynamic_model": "table"}))
    assert [fault.field for fault in wrong] == [field]
    for model in ("published", "relative_wind"):
        options = {"aerodynamic_model": model}
        assert gather(parts_of_line, schemas.Analysis.model_validate(options))[2] == []


def test_every_choice_of_an_analysis_arrives_in_the_engine() -> None:
    choices = {
        field.name: list(type(field.default)) for field in fields(spec.Analysis) if isinstance(field.default, Enum)
    }
    assert len(choices) >= 9
    for name, members in choices.items():
        for member in members:
            line = changed("wind", {})
            if member is spec.AerodynamicModel.TABLE:
                line = changed("ice", {"aerodynamics": circle()}, line)
            _, analysis = built(line, {name: member.value})
            assert getattr(analysis, name) is member, (name, member)


@pytest.mark.parametrize(
    ("analysis", "expected"),
    [
        ({}, ("full", "relative_wind", "condensed", "included", "where_large")),
        ({"physics": "source"}, ("source", "published", "neglected", "neglected", "neglected")),
        (
            {"physics": "source", "static_twist": "solved"},
            ("source", "published", "neglected", "neglected", "solved"),
        ),
        ({"physics": "full"}, ("full", "relative_wind", "condensed", "included", "where_large")),
        (
            {"physics": "full", "longitudinal_inertia": "neglected"},
            ("full", "relative_wind", "neglected", "included", "where_large"),
        ),
        (
            {"physics": "full", "stretching": "neglected", "static_twist": "neglected"},
            ("full", "relative_wind", "condensed", "neglected", "neglected"),
        ),
        ({"physics": None}, ("full", "relative_wind", "condensed", "included", "where_large")),
        (
            {"physics": None, "aerodynamic_model": "published"},
            ("full", "published", "condensed", "included", "where_large"),
        ),
    ],
)
def test_physics_sets_what_is_not_said_singly(analysis: dict[str, Any], expected: tuple[str, ...]) -> None:
    _, asked = built(FULL_LINE, analysis)
    options = (asked.aerodynamic_model, asked.longitudinal_inertia, asked.stretching, asked.static_twist)
    found = (asked.physics, *options)
    assert found == expected
    assert asked.lacks is None


def test_every_device_of_the_schema_has_its_class_in_the_engine() -> None:
    types = {get_args(device.model_fields["type"].annotation)[0] for device in get_args(get_args(schemas.Device)[0])}
    assert types == set(parts.DEVICES)


def test_absent_parts_are_the_defaults_of_the_engine() -> None:
    line, analysis = built(example("c11-single"))
    assert analysis == spec.Analysis(lacks="ice.aerodynamics_at_rest")  # which the source does not print
    assert line.supports == spec.Supports()
    assert line.wind == spec.Wind()
    assert line.bundle == spec.Bundle()


def test_area_and_modulus_make_the_rigidity() -> None:
    line = changed("conductor.area_m2", 4e-4, changed("conductor.youngs_modulus_pa", 5e10))
    del line["conductor"]["axial_rigidity_n"]
    assert built(line)[0].conductor.axial_rigidity == pytest.approx(2e7)


def test_positions_are_taken_as_they_stand() -> None:
    line = changed("bundle", {"positions_m": [[0.1, -0.2], [-0.1, 0]]})
    assert built(line)[0].bundle.positions == ((0.1, -0.2), (-0.1, 0.0))


@pytest.mark.parametrize("section", [None, *spec.CrossSection])
def test_every_kind_of_section_and_yoke_arrives(section: spec.CrossSection | None) -> None:
    line = changed("bundle.section", None if section is None else section.value)
    for physics, default in (("full", spec.CrossSection.FREE), ("source", spec.CrossSection.RIGID)):
        assert built(line, {"physics": physics})[0].bundle.section is (section or default)
    for yoke in (None, *spec.Yoke):
        line = changed("supports.right.yoke", None if yoke is None else yoke.value)
        assert built(line)[0].supports.right.yoke is yoke
