"""The figures by which the lines of a batch are ranked, from the results of each line."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from engine import spec
from engine.outcome import Outcome, Stability
from engine.result import LimitCycleRow, Orbit, Result

if TYPE_CHECKING:
    from engine.arrays import FloatArray

_PHASES = 120  # amplitudes to 0.04 %
_ORBITS_AT_ONCE = 512  # of four sub-conductors they have 4 MB of points

_Motion = tuple[LimitCycleRow, Orbit | None]
_Room = tuple[float, float]


def ranking_figures(lines: Sequence[spec.Line], results: Sequence[Result]) -> list[dict[str, float | None]]:
    """Return the lowest critical wind speed of each line, and its largest stable motion at the analysis' wind speeds.

    Height and width [m] bound the space that the sub-conductors sweep at the observation point. A motion of unknown
    stability counts as stable. A line with a motion without numbers at any wind speed, because it is not known or
    nothing bounds it, or with a wind speed at which nothing is known to be stable, has infinite figures, so that it
    ranks before all others. A line that is unstable without wind has the critical wind speed 0 besides. None: no
    crossing up to the limit, or no wind speed asked for. Hours of which nothing is known count as galloping;
    None without a climate.
    """
    lasting = [_may_last(result) for result in results]
    moving = [place for place, motions in enumerate(lasting) if motions]
    rooms = dict(zip(moving, _rooms([(lines[i], lasting[i]) for i in moving]), strict=True))
    return [_figures(result, lasting[i], rooms.get(i)) for i, result in enumerate(results)]


def _may_last(result: Result) -> list[_Motion]:
    """Return the motions that are not known to be unstable, with their orbits where these are known."""
    orbits = {orbit.cycle: orbit for orbit in result.orbits}
    cycles = enumerate(result.limit_cycles)
    stable = [(i, row) for i, row in cycles if row.stability is not Stability.UNSTABLE]
    return [(row, orbits.get(i) if row.kind == "periodic" else None) for i, row in stable]


def _figures(result: Result, lasting: Sequence[_Motion], room: _Room | None) -> dict[str, float | None]:
    winds = [row.wind_speed_m_per_s for row in result.critical_wind_speeds]
    winds += [0.0 for row in result.frequencies if row.outcome is Outcome.STATICALLY_UNSTABLE]
    amplitudes = [row.vertical_m for row, _ in lasting if row.vertical_m is not None]
    height, width = room or (None, None)
    if _has_unknown_motion(result):
        amplitudes, height, width = [math.inf], math.inf, math.inf
    return {
        "lowest_critical_wind_speed_m_per_s": min(winds, default=None),
        "largest_vertical_m": max(amplitudes, default=None),
        "largest_height_m": height,
        "largest_width_m": width,
        "galloping_hours_a_year": max(
            (row.hours_a_year + row.unknown_hours_a_year for row in result.risk), default=None
        ),
    }


def _has_unknown_motion(result: Result) -> bool:
    """Return whether a motion has no numbers, or a model nothing that is known to be stable at some wind speed."""
    rows = result.limit_cycles
    places = {(row.model, row.wind_speed_m_per_s) for row in rows}
    stable = {(row.model, row.wind_speed_m_per_s) for row in rows if row.stability is Stability.STABLE}
    return places != stable or any(row.vertical_m is None for row in rows)


def _rooms(moving: Sequence[tuple[spec.Line, Sequence[_Motion]]]) -> list[_Room]:
    """Return height and width of the space that each line's stable motions sweep, all lines together.

    They are exact from orbits, and upper bounds where only amplitudes are known.
    """
    import numpy as np  # noqa: PLC0415 - the API and `galloping --help` need no numerics

    if not moving:
        return []
    positions = np.array(_equally_many([line.bundle.positions for line, _ in moving]))
    motions = [motion for _, of_line in moving for motion in of_line]
    owner = np.repeat(np.arange(len(moving)), [len(of_line) for _, of_line in moving])
    found = np.ptp(positions, axis=1)
    most, least = _bounds(motions, np.abs(positions).max(axis=1)[owner, ::-1])
    most += found[owner]
    np.maximum.at(found, owner, np.where([[orbit is None] for _, orbit in motions], most, 0.0))
    # Skip orbits that cannot reach as far as another orbit of their line surely does.
    surely = np.maximum.reduceat(least, np.searchsorted(owner, range(len(moving))))
    far = np.flatnonzero((most >= surely[owner]).any(axis=-1)).tolist()
    reaching = [(place, orbit) for place in far if (orbit := motions[place][1]) is not None]
    for first in range(0, len(reaching), _ORBITS_AT_ONCE):
        places, orbits = zip(*reaching[first : first + _ORBITS_AT_ONCE], strict=True)
        here = owner[list(places)]
        np.maximum.at(found, here, _reached(orbits, positions[here]))
    return [(height, width) for height, width in found.tolist()]


def _equally_many(bundles: Sequence[tuple[tuple[float, float], ...]]) -> list[tuple[tuple[float, float], ...]]:
    """Repeat a sub-conductor of smaller bundles, which does not change the space that they take."""
    most = max(map(len, bundles))
    return [positions + positions[:1] * (most - len(positions)) for positions in bundles]


def _bounds(motions: Sequence[_Motion], arms: "FloatArray") -> "tuple[FloatArray, FloatArray]":
    """Return upper and lower bounds of height and width (motions, 2) of a motion, without the bundle's own size [m]."""
    import numpy as np  # noqa: PLC0415 - as above

    moved = np.array([(row.vertical_m or 0.0, row.horizontal_m or 0.0) for row, _ in motions])
    mean = [0.0 if orbit is None else abs(orbit.torsional[0]) for _, orbit in motions]
    turned = (np.array([(row.torsional_rad or 0.0) for row, _ in motions]) + mean)[:, None] * arms
    return 2.0 * (moved + turned), 2.0 * (moved - turned)


def _reached(orbits: Sequence[Orbit], positions: "FloatArray") -> "FloatArray":
    """Return height and width (orbits, 2) of the space swept by sub-conductors at positions (orbits, n, 2) [m]."""
    import numpy as np  # noqa: PLC0415 - as above

    from engine.clearance import extents, subconductor_paths  # noqa: PLC0415 - as above

    series = np.zeros((len(orbits), 3, max(len(orbit.vertical) for orbit in orbits)))
    for place, orbit in zip(series, orbits, strict=True):
        place[:, : len(orbit.vertical)] = orbit.vertical, orbit.horizontal, orbit.torsional
    return extents(subconductor_paths(series, positions, _PHASES))
