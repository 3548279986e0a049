"""Convert JSON models to engine dataclasses, one part at a time; degrees become radians here and nowhere else.

Every function raises `InvalidSpec` for what the engine refuses. Fault paths begin at the line's root where the engine
knows it, otherwise at the part itself.
"""

import math
from collections.abc import Mapping
from dataclasses import fields, replace
from enum import StrEnum
from typing import Any, TypeVar

from app import schemas
from app.schemas.known import KnownSpan
from app.schemas.placement import Range
from engine import spec
from engine.outcome import Fault, InvalidSpec, require

Choice = TypeVar("Choice", bound=StrEnum)
Made = TypeVar("Made", bound=spec.Device | spec.PendulumChoice | spec.SpoilerChoice)

DEVICES: Mapping[str, type[spec.Device]] = {
    "spacer": spec.Spacer,
    "detuning_pendulum": spec.DetuningPendulum,
    "airflow_spoiler": spec.AirflowSpoiler,
    "torsional_damper": spec.TorsionalDamper,
    "interphase_spacer": spec.InterphaseSpacer,
}
_OF_ICING = ("hours", "events", "event_hours", "persistence")
_CHOICES: Mapping[str, type[spec.PendulumChoice | spec.SpoilerChoice]] = {
    "detuning_pendulum": spec.PendulumChoice,
    "airflow_spoiler": spec.SpoilerChoice,
}


def conductor(part: schemas.Conductor) -> spec.Conductor:
    """Build a sub-conductor; compute its axial rigidity from area and modulus if it is not given."""
    rigidity = part.axial_rigidity
    if rigidity is None:
        rigidity = (part.area or 0.0) * (part.youngs_modulus or 0.0)
    return spec.Conductor(
        diameter=part.diameter,
        axial_rigidity=rigidity,
        torsional_rigidity=part.torsional_rigidity,
        mass=part.mass,
        polar_inertia=part.polar_inertia,
        axial_torsional_coupling=part.axial_torsional_coupling,
        rated_strength=part.rated_strength,
    )


def bundle(part: schemas.Bundle) -> spec.Bundle:
    """Build the arrangement from positions or from a circle."""
    section = spec.CrossSection(part.section) if part.section else None
    if part.positions is not None:
        return spec.Bundle(tuple((y, z) for y, z in part.positions), section)
    orientation = math.radians(part.orientation or 0.0)
    return spec.Bundle.regular(part.subconductors or 1, part.radius or 0.0, orientation, section)


def span(part: schemas.Span | KnownSpan) -> spec.Span:
    """Build the span from its iced tension, in either form of a line."""
    return spec.Span(
        length=part.length,
        horizontal_tension=part.horizontal_tension,
        catenary_parameter=part.catenary_parameter,
        sag=part.sag,
        elements=part.elements,
        level_difference=part.level_difference,
    )


def support(part: schemas.Support) -> spec.Support:
    """Build one end."""
    yoke = spec.Yoke(part.yoke) if part.yoke else None
    return spec.Support(part.dead_end, part.adjacent_span, part.insulator_length, part.insulator_weight, yoke)


def supports(part: schemas.Supports) -> spec.Supports:
    """Build both ends."""
    return spec.Supports(part.longitudinal_stiffness, support(part.left), support(part.right))


def section(part: schemas.Section) -> spec.Section:
    """Build a section without the ice of its spans, which `assemble` adds."""
    return spec.Section(
        spans=tuple(
            spec.SectionSpan(
                span.length,
                span.level_difference,
                profile=None if span.profile is None else tuple((p.position, p.factor) for p in span.profile),
            )
            for span in part.spans
        ),
        strings=tuple(spec.SuspensionString(string.length, string.weight) for string in part.strings),
        span_of_interest=part.span_of_interest,
    )


def aerodynamics(
    part: schemas.Aerodynamics | schemas.MeasuredCoefficients, at_rest: schemas.AerodynamicsAtRest | None
) -> spec.Aerodynamics:
    """Build the coefficients from cubics and values at rest, or from a table."""
    if isinstance(part, schemas.MeasuredCoefficients):
        rule = "must be absent if a table is given, which contains the values at rest"
        require(Fault("at_rest", None, rule) if at_rest else None)
        return _fitted(part)
    return spec.Aerodynamics(
        vertical=_three(part.vertical),
        horizontal=_three(part.horizontal),
        torsional=_three(part.torsional),
        at_rest=(at_rest.vertical, at_rest.horizontal, at_rest.torsional) if at_rest else None,
        fitted_range=None if part.fitted_range is None else math.radians(part.fitted_range),
    )


def _fitted(part: schemas.MeasuredCoefficients) -> spec.Aerodynamics:
    from engine.mechanics.coefficients import fit_measured  # noqa: PLC0415 - lines without a table need no numerics

    rows = [(math.radians(row.angle), row.lift, row.drag, row.moment) for row in part.table]
    angle, lift, drag, moment = zip(*rows, strict=True)
    static, half_range = math.radians(part.static_angle), math.radians(part.half_range)
    try:
        return fit_measured(spec.MeasuredCoefficients(angle, lift, drag, moment, static, half_range))
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"aerodynamics.{f.field}") for f in error.faults)) from error


def segment(part: schemas.IceSegment) -> spec.IceSegment:
    """Build a stretch with other ice."""
    own = aerodynamics(part.aerodynamics, part.at_rest) if part.aerodynamics else None
    return spec.IceSegment(part.start, part.stop, own, part.eccentricity_y, part.eccentricity_z, part.mass)


def wind(part: schemas.Wind) -> spec.Wind:
    """Build the wind, except its speed."""
    mean = part.blow_out
    blow_out = spec.BlowOut(mean.wind_speed, mean.drag_coefficient) if mean else None
    profile = tuple((point.position, point.factor) for point in part.profile)
    return spec.Wind(part.air_density, profile, blow_out, math.radians(part.yaw))


def damping(part: schemas.Damping) -> spec.Damping:
    """Build the damping."""
    model = spec.DampingModel(part.model)
    return spec.Damping(part.vertical_ratio, part.horizontal_ratio, part.torsional_ratio, model)


def device(part: schemas.Device) -> spec.Device:
    """Build a device of any kind."""
    return _by_name(DEVICES[part.type], part)


def _by_name(made: type[Made], part: schemas.Document) -> Made:
    """Build what has fields of the same names: degrees become radians, ranges become pairs."""
    return made(**{name: _value(part, name) for name in (field.name for field in fields(made))})


def _value(part: schemas.Document, name: str) -> Any:
    given, unit = getattr(part, name), type(part).model_fields[name].json_schema_extra
    if name == "aerodynamics":
        return aerodynamics(given, getattr(part, "at_rest", None))
    if name == "between":
        return tuple(given)
    if isinstance(given, Range):
        return given.pair
    return math.radians(given) if unit == {"x-unit": "deg"} else given


def climate(part: schemas.Climate) -> spec.Climate:
    """Build the climate."""
    return spec.Climate(
        azimuth=math.radians(part.azimuth),
        sectors=tuple(
            spec.WindSector(
                direction=math.radians(sector.direction),
                share=sector.share,
                shape=_required_range(sector, "shape"),
                scale=_required_range(sector, "scale"),
                width=None if sector.width is None else math.radians(sector.width),
            )
            for sector in part.sectors
        ),
        icing=tuple(
            spec.Icing(icing.kind, icing.thickness, *(_range(icing, name) for name in _OF_ICING))
            for icing in part.icing
        ),
        record=None
        if part.record is None
        else spec.IcedRecord(part.record.years, tuple(tuple(winds) for winds in part.record.events)),
    )


def _range(part: schemas.Document, name: str) -> spec.Ranged | None:
    """Return a number with its ends, None if it is not given."""
    return None if getattr(part, name) is None else _required_range(part, name)


def _required_range(part: schemas.Document, name: str) -> spec.Ranged:
    return spec.Ranged(getattr(part, name), getattr(part, f"{name}_lowest"), getattr(part, f"{name}_highest"))


def placement(part: schemas.Placement) -> spec.Placement:
    """Build a search for the placement of devices."""
    return spec.Placement(
        choice=_choice(part.choice),
        objective=spec.Objective(part.objective),
        generations=part.generations,
        population=part.population,
        seed=part.seed,
        separation=part.separation,
    )


def _choice(part: schemas.PendulumChoice | schemas.SpoilerChoice) -> spec.PendulumChoice | spec.SpoilerChoice:
    try:
        return _by_name(_CHOICES[part.type], part)
    except InvalidSpec as error:
        raise InvalidSpec(*(replace(f, field=f"choice.{f.field}") for f in error.faults)) from error


def physics(part: schemas.Analysis) -> spec.PhysicsRequest:
    """Build the choice of physics that a request makes."""
    return spec.PhysicsRequest(
        physics=_choice_of(spec.Physics, part.physics),
        aerodynamic_model=_choice_of(spec.AerodynamicModel, part.aerodynamic_model),
        longitudinal_inertia=_choice_of(spec.LongitudinalInertia, part.longitudinal_inertia),
        stretching=_choice_of(spec.Stretching, part.stretching),
        static_twist=_choice_of(spec.StaticTwist, part.static_twist),
    )


def _choice_of(options: type[Choice], word: str | None) -> Choice | None:
    return None if word is None else options(word)


def analysis(part: schemas.Analysis) -> spec.Analysis:
    """Build the analysis, except what its physics decides."""
    return spec.Analysis(
        loops=tuple(part.loops),
        models=tuple(spec.Model(model) for model in part.models),
        wind_speeds=part.speeds(),
        closure=spec.Closure(part.closure),
        aerodynamic_load=spec.AerodynamicLoad(part.aerodynamic_load),
        critical_wind_limit=part.critical_wind_limit,
        harmonics=part.harmonics,
        finite_element_loops=tuple(part.finite_element_loops),
        loop_competition=spec.LoopCompetition(part.loop_competition),
        quasi_periodic=spec.TorusSearch(part.quasi_periodic),
        device_effect=spec.DeviceEffect(part.device_effect),
        amplitude_curves=spec.AmplitudeCurves(part.amplitude_curves),
        check=spec.Check(part.check),
        risk=part.risk is not False,
    )


def uncertainty(part: schemas.Uncertainty | None) -> spec.Uncertainty:
    """Build what is asked of the samples of a line by itself."""
    return spec.Uncertainty() if part is None else spec.Uncertainty(part.samples, part.seed)


def _three(values: list[float]) -> spec.Coefficients:
    first, second, third = values
    return float(first), float(second), float(third)
