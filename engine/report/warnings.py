"""The warnings of a result: assumptions that a line does not meet, and solutions that are left out."""

import math
from collections import Counter
from collections.abc import Sequence

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.along_span import mean_mass
from engine.mechanics.static_twist import LARGE_TWIST, linear_twist
from engine.models.discretization import Discretization
from engine.models.relative_wind import FASTEST
from engine.outcome import Outcome, Stability
from engine.report.findings import ModelFindings
from engine.result import LimitCycleRow
from engine.spec import (
    AerodynamicModel,
    Aerodynamics,
    Analysis,
    CrossSection,
    Ice,
    IceSegment,
    Line,
    LongitudinalInertia,
    Model,
    StaticTwist,
    StretchDevice,
    Stretching,
    ice_properties,
)

HEAVY_DEVICES = 0.1  # share of the span's weight above which a warning names the devices' weight
LINEAR_TWIST = math.radians(15.0)  # up to which the linear estimate of the static twist holds within some per cent
MOTION_WARNINGS = {
    Outcome.BEYOND_DATA: "{} motions reach beyond what the input can vouch for: an angle of attack over 30 degrees "
    "although no range of the coefficients is given (fitted_range_deg), or an amplitude over the static sag. They "
    "satisfy the equations; whether the line moves like that is not known.",
    Outcome.NO_BOUNDED_MOTION: "At {} combinations of model, loops and wind speed no motion is bounded: every motion "
    "that was integrated grew past an angle of attack of 180 degrees.",
}
LEAST_RELIEVED = 0.25  # k_0/k below which one relief coordinate is several per cent off in the frequency
MUCH_LONGITUDINAL = 0.1  # share of a vertical shape's energy above which a warning names it
LEAST_INERTIA = 1e-6  # least ratio of the inertias about mass centre and reference curve: M is nearly singular below it


def line_warnings(line: Line) -> list[str]:
    """Return a sentence for each assumption of the static profile and of the mass matrix that a line does not meet."""
    result = []
    subconductors = len(line.bundle.positions)
    mass = mean_mass(line) * line.span.length * subconductors
    share = sum(device.total_mass(subconductors) for device in line.devices) / mass
    if share > HEAVY_DEVICES:
        result.append(
            f"The devices weigh {share:.0%} of the span. The static profile neglects their weight, which is accurate "
            f"only below {HEAVY_DEVICES:.0%}."
        )
    masses = [line.conductor.mass, *(s.mass for s in line.ice.segments if s.mass is not None)]
    if max(masses) > (1.0 + HEAVY_DEVICES) * min(masses):
        result.append("The ice mass varies along the span; the static profile uses its mean.")
    pieces: list[Ice | IceSegment] = [line.ice, *line.ice.segments]
    share = min(_inertia_share(line, piece) for piece in pieces)
    if share < LEAST_INERTIA:
        result.append(
            f"The polar inertia about the mass centre is only {share:.1e} of that about the reference curve: the mass "
            "matrix is ill-conditioned, and torsional frequencies and motions lose a corresponding number of digits."
        )
    if line.climate is not None and len(line.climate.icing) > 1:
        result.append("The climate has several kinds of ice, and the line one: it stands for all of them in the risk.")
    return result


def physics_warnings(line: Line, analysis: Analysis) -> list[str]:
    """Return sentences on physics that the line's data kept from being full, and on values at rest taken from it."""
    result = []
    if analysis.lacks is not None:
        result.append(
            f"The physics is the source's, because {analysis.lacks} is not given: {_neglected(line, analysis)}. Motion "
            f"in two and more loops depends on it. Give {analysis.lacks}, or a measured table in the place of "
            'ice.aerodynamics, for full physics, or ask for "physics": "source".'
        )
    if analysis.aerodynamic_model is AerodynamicModel.PUBLISHED:
        return result
    parts: list[tuple[str, Sequence[IceSegment | StretchDevice]]]
    parts = [(f"ice.segments.{i}", [segment]) for i, segment in enumerate(line.ice.segments)]
    parts += [(f"devices.{i}", device.stretches) for i, device in enumerate(line.devices)]
    without = [name for name, owners in parts if any(_lacks_rest(owner.aerodynamics) for owner in owners)]
    if without:
        names = ", ".join(without)
        result.append(f"The line's coefficients at rest are used where {names} give no aerodynamics_at_rest.")
    return result


def longitudinal_warnings(loops: Sequence[int], shares: FloatArray, analysis: Analysis) -> list[str]:
    """Return a sentence if vertical shapes hold much longitudinal motion, whose share is shares (loops,)."""
    asked = [(k, share) for k, share in zip(loops, shares.tolist(), strict=True) if k in analysis.loops]
    mixed = [f"{k} ({share:.0%})" for k, share in asked if share > MUCH_LONGITUDINAL]
    if not mixed:
        return []
    known = f"Vertical motion is partly longitudinal for these numbers of loops (share of energy): {', '.join(mixed)}."
    if analysis.longitudinal_inertia is LongitudinalInertia.NEGLECTED and Model.HYBRID in analysis.models:
        excess = 1.0 / math.sqrt(1.0 - max(share for _, share in asked)) - 1.0
        known += (
            f" The hybrid model neglects that inertia, which overstates a vertical frequency by about {excess:.0%}; "
            '"longitudinal_inertia": "condensed" keeps it.'
        )
    return [known]


def section_warnings(line: Line, analysis: Analysis) -> list[str]:
    """Return sentences on what the hybrid model of a section leaves out, and on a table that is not computed."""
    result = []
    if line.has_table and analysis.static_twist is not StaticTwist.NEGLECTED:
        result.append("The static equilibria in the wind are not computed for a section.")
    if Model.HYBRID not in analysis.models or not analysis.wind_speeds:
        return result
    return [
        *result,
        "The hybrid model of a section moves one vertical mode at a time. Modes of several spans have nearly equal "
        "frequencies and critical wind speeds, so a motion that is stable by itself may give way to another mode; the "
        "finite element model, which moves the modes of finite_element_loops together, tells.",
    ]


def relief_warnings(analysis: Analysis, relieved: float) -> list[str]:
    """Return a sentence if one relief coordinate is not enough for the hybrid model; relieved: its k_0/k."""
    several = [k for k in analysis.loops if k > 1]
    if analysis.stretching is Stretching.NEGLECTED or Model.HYBRID not in analysis.models or not several:
        return []
    if relieved >= LEAST_RELIEVED:
        return []
    return [
        f"The sag relieves this span so much (a share of {relieved:.2f} of its stiffness is left) that one relief "
        "coordinate is some 5 % off in the rise of frequency by stretching at moderate amplitudes, and up to 40 % "
        "at large ones, in two and more loops of the hybrid model. The finite element model with "
        "finite_element_loops 1, 2, 3 and 5 is better."
    ]


def _neglected(line: Line, analysis: Analysis) -> str:
    """Return what an analysis with the source's physics neglects, as a clause."""
    parts = []
    if analysis.aerodynamic_model is AerodynamicModel.PUBLISHED:
        parts.append("how the horizontal velocity and the rotation of the sub-conductors change the wind")
    if analysis.longitudinal_inertia is LongitudinalInertia.NEGLECTED:
        parts.append("the longitudinal inertia of the hybrid model")
    if analysis.stretching is Stretching.NEGLECTED:
        parts.append("the stretching of the conductors by large motion")
    if line.bundle.section is CrossSection.RIGID:
        parts.append("that sub-conductors move along the span by themselves")
    return "it neglects " + "; ".join(parts) if parts else "the request sets every option itself"


def _lacks_rest(aerodynamics: Aerodynamics | None) -> bool:
    return aerodynamics is not None and aerodynamics.at_rest is None


def _inertia_share(line: Line, piece: Ice | IceSegment) -> float:
    """Return the section's polar inertia about its mass centre over that about the reference curve."""
    e_y, e_z, mass = ice_properties(line, piece)
    positions = line.bundle.positions
    y, z = (sum(coordinates) / len(positions) for coordinates in zip(*positions, strict=True))
    spread = sum((own_y - y) ** 2 + (own_z - z) ** 2 for own_y, own_z in positions) / len(positions)
    about_mass_centre = line.conductor.polar_inertia - mass * (e_y**2 + e_z**2) + mass * spread
    return float(about_mass_centre / (about_mass_centre + mass * ((y + e_y) ** 2 + (z + e_z) ** 2)))


def twist_warnings(discretization: Discretization, line: int) -> list[str]:
    """Return a sentence if the static twist of a line was asked for but could not be computed."""
    if discretization.twist is None or discretization.twist.outcome[line] in (None, Outcome.CONVERGED):
        return []
    return ["The static twist could not be computed; all results refer to the untwisted state."]


def wind_twist_warnings(discretization: Discretization, line: int) -> list[str]:
    """Return a sentence for each table of a line that is no curve, where the twist in the wind is asked for."""
    if discretization.wind_twist is None:
        return []
    return [
        f"The static equilibria in the wind are not computed, because a table of coefficients is no curve: {fault}."
        for fault in discretization.lines[line].curve_faults()
    ]


def neglected_twist_warnings(discretization: Discretization, unstable: BoolArray) -> list[list[str]]:
    """Return a sentence for each line whose neglected static twist matters: one list per line.

    unstable: (lines,), whether a model of the line is statically unstable.
    """
    lines = discretization.lines
    if discretization.twist is not None:
        return [[] for _ in lines]
    angle = linear_twist(lines, discretization.profile, discretization.sections, discretization.matrices)
    return [_neglected_twist(float(a), bool(fails)) for a, fails in zip(angle, unstable, strict=True)]


def _neglected_twist(angle: float, unstable: bool) -> list[str]:
    """Return the sentence about a neglected twist of a size [rad], none if it is small."""
    if unstable:
        return [
            "The ice moment exceeds the torsional stiffness, so the line cannot hang as it was given. Set static_twist "
            "to solved to analyse it about the angle to which the ice turns it."
        ]
    if angle <= LARGE_TWIST:
        return []
    size = f"about {math.degrees(angle):.0f}" if angle <= LINEAR_TWIST else f"more than {math.degrees(LARGE_TWIST):.0f}"
    return [
        f"Eccentric ice would turn this line by {size} degrees from the angles and eccentricity that were given. They "
        "are taken as those of the line as it hangs; if they describe the untwisted line, set static_twist to solved."
    ]


def fit_warnings(cycles: Sequence[LimitCycleRow], analysis: Analysis) -> list[str]:
    """Return a sentence if cycles leave the fitted range of the coefficients, and one if the range of the expansion."""
    beyond = Outcome.OUTSIDE_FIT  # looked up once: that takes longer than the comparison
    outside = [cycle for cycle in cycles if cycle.outcome is beyond]
    expanded = analysis.aerodynamic_model is not AerodynamicModel.PUBLISHED and not analysis.load_stands
    fast = sum(expanded and (cycle.largest_velocity_ratio or 0.0) > FASTEST for cycle in outside)
    result = []
    if len(outside) > fast:
        left = len(outside) - fast
        result.append(f"{left} cycles leave the range of angles of attack to which the coefficients were fitted.")
    if fast:
        result.append(
            f"In {fast} cycles a sub-conductor moves faster than {FASTEST:g} of the wind. The load is expanded in the "
            "velocity and does not hold there."
        )
    return result


def motion_warnings(motions: Sequence[LimitCycleRow]) -> list[str]:
    """Return a sentence for each way in which motions go beyond what the input carries, and for missing ones."""
    counts = Counter(motion.outcome for motion in motions)
    if counts[Outcome.BEYOND_DATA]:
        # An unstable cycle without data to carry it is no motion that anyone would see, so its row says enough.
        unseen = (Outcome.BEYOND_DATA, Stability.UNSTABLE)
        counts[Outcome.BEYOND_DATA] -= sum((motion.outcome, motion.stability) == unseen for motion in motions)
    return [text.format(counts[outcome]) for outcome, text in MOTION_WARNINGS.items() if counts[outcome]]


def dropped_warnings(findings: ModelFindings, lines: int) -> list[list[str]]:
    """Return a sentence for each line some of whose solutions are left out: one list per line."""
    count = np.bincount(findings.line, weights=findings.cycles.dropped, minlength=lines).astype(int)
    text = (
        "{} solutions of the {} model at large angles of attack are left out, since more harmonics do not resolve them."
    )
    return [[text.format(n, findings.name.value.replace("_", " "))] if n else [] for n in count]
