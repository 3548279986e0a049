"""The static twist compared with the elliptic integral, and its effect on long spans."""

import math
from collections.abc import Iterator
from dataclasses import replace

from scipy.optimize import brentq
from scipy.special import ellipk

from benchmarks.lines import source_line
from benchmarks.validation.common import percent, result, table
from engine.mechanics.static_profile import static_profile
from engine.result import Result
from engine.spec import GRAVITY, Analysis, Line, Model, StaticTwist

LENGTHS = (120.0, 145.0, 160.0, 200.0, 300.0, 500.0)
ASKED = Analysis(loops=(1,), models=(Model.HYBRID,), wind_speeds=(4.0,))


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Static twist of long single spans\n"
    yield (
        "The source's single conductor on other spans. With the mass centre straight above (e_z = 0), torsion buckles "
        "at the length pi sqrt(GJ/(m g e_y)). Beyond it, the largest twist follows from K(sin(Theta/2)) = L/2 sqrt(m g "
        "e_y/GJ), where K is the complete elliptic integral. With the source's e_z the section twists at every length. "
        "The last three columns are for one loop of the hybrid model, without and with the twist.\n"
    )
    head = ["span m", "largest twist, e_z = 0, rad", "elliptic integral", "difference %"]
    head += ["largest twist, e_z of Table 1, rad", "onset m/s, twist neglected", "onset m/s, twist solved"]
    head += ["torsion Hz, solved"]
    yield table(head, [_row(length) for length in LENGTHS])


def _row(length: float) -> list[object]:
    line = source_line(1)
    line = replace(line, span=replace(line.span, length=length))
    centred = replace(line, ice=replace(line.ice, eccentricity_z=0.0))
    twist = result(centred, replace(ASKED, static_twist=StaticTwist.SOLVED)).static.twist_rad or 0.0
    exact = _post_buckled(centred)
    solved = result(line, replace(ASKED, static_twist=StaticTwist.SOLVED))
    cells = [f"{length:g}", f"{abs(twist):.4f}", f"{exact:.4f}", percent(abs(twist), exact) if exact else ""]
    frequency = solved.frequencies[0].torsional_hz
    return [*cells, f"{solved.static.twist_rad:.4f}", _onset(line, ASKED), _onset_of(solved), f"{frequency:.3f}"]


def _post_buckled(line: Line) -> float:
    arc = float(static_profile((line,)).arc_length[0])
    weight = line.conductor.mass * GRAVITY * line.ice.eccentricity_y
    half = 0.5 * arc * math.sqrt(weight / line.conductor.torsional_rigidity)
    if half <= 0.5 * math.pi:
        return 0.0
    return float(brentq(lambda x: ellipk(math.sin(0.5 * x) ** 2) - half, 1e-9, math.pi - 1e-12))


def _onset(line: Line, asked: Analysis) -> str:
    found = result(line, asked)
    unstable = any(row.outcome.value == "statically_unstable" for row in found.limit_cycles)
    return "statically unstable" if unstable else _onset_of(found)


def _onset_of(found: Result) -> str:
    speeds = [row.wind_speed_m_per_s for row in found.critical_wind_speeds if row.crossing == "onset"]
    return f"{min(speeds):.3f}" if speeds else "none"
