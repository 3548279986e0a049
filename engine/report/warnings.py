"""The warnings of a result: assumptions that a line does not meet, and solutions that are left out."""

from collections.abc import Sequence

import numpy as np

from engine.mechanics.static_profile import mean_mass
from engine.models.discretization import Discretization
from engine.outcome import Outcome
from engine.report.findings import ModelFindings
from engine.result import LimitCycleRow
from engine.spec import Ice, IceSegment, Line, ice_properties

HEAVY_DEVICES = 0.1  # share of the span's weight above which a warning names the devices' weight
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
    return result


def _inertia_share(line: Line, piece: Ice | IceSegment) -> float:
    """Return the section's polar inertia about its mass centre over that about the reference curve."""
    e_y, e_z, mass = ice_properties(line, piece)
    centres = np.add(line.bundle.positions, (e_y, e_z))
    own = line.conductor.polar_inertia - mass * (e_y**2 + e_z**2)
    about_mass_centre = own + mass * centres.var(axis=0).sum()
    return float(about_mass_centre / (own + mass * (centres**2).sum(axis=-1).mean()))


def twist_warnings(discretization: Discretization, line: int) -> list[str]:
    """Return a sentence if the static twist of a line was asked for but could not be computed."""
    if discretization.twist is None or discretization.twist.outcome[line] is Outcome.CONVERGED:
        return []
    return ["The static twist could not be computed; all results refer to the untwisted state."]


def fit_warnings(cycles: Sequence[LimitCycleRow]) -> list[str]:
    """Return a sentence if cycles leave the fitted range of the aerodynamic coefficients."""
    outside = sum(cycle.outcome is Outcome.OUTSIDE_FIT for cycle in cycles)
    if not outside:
        return []
    return [f"{outside} cycles leave the range of angles of attack to which the coefficients were fitted."]


def dropped_warnings(findings: ModelFindings, lines: int) -> list[list[str]]:
    """Return a sentence for each line some of whose solutions are left out: one list per line."""
    count = np.bincount(findings.line, weights=findings.cycles.dropped, minlength=lines).astype(int)
    text = (
        "{} solutions of the {} model at large angles of attack are left out, since more harmonics do not resolve them."
    )
    return [[text.format(n, findings.name.value.replace("_", " "))] if n else [] for n in count]
