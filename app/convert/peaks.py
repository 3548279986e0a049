"""The figures by which the lines of a batch are ranked, out of everything that was found for a line."""

from collections.abc import Sequence

from engine import spec
from engine.outcome import Outcome, Stability
from engine.result import LimitCycleRow, Orbit, Result

_PHASES = 120  # amplitudes to 0.04 %


def peaks(line: spec.Line, result: Result) -> dict[str, float | None]:
    """Return the lowest critical wind speed, and the largest motion that lasts at the wind speeds asked for.

    Height and width [m] are of all that the sub-conductors reach where the motion is observed. None where nothing is
    known: no crossing up to the limit, or no motion whose stability was decided. A line that is unstable without wind
    has the critical wind speed 0.
    """
    lasting = [(i, row) for i, row in enumerate(result.limit_cycles) if row.stability is Stability.STABLE]
    winds = [row.wind_speed_m_per_s for row in result.critical_wind_speeds]
    winds += [0.0 for row in result.frequencies if row.outcome is Outcome.STATICALLY_UNSTABLE]
    amplitudes = [row.vertical_m for _, row in lasting if row.vertical_m is not None]
    orbits = {orbit.cycle: orbit for orbit in result.orbits}
    known = [(row, orbits[i] if row.kind == "periodic" and i in orbits else None) for i, row in lasting]
    height, width = _extents(line, known) if lasting else (None, None)
    return {
        "lowest_critical_wind_speed_m_per_s": min(winds, default=None),
        "largest_vertical_m": max(amplitudes, default=None),
        "largest_height_m": height,
        "largest_width_m": width,
    }


def _extents(line: spec.Line, motions: Sequence[tuple[LimitCycleRow, Orbit | None]]) -> tuple[float, float]:
    """Return height and width of the largest motions: exact from orbits, from above where there are amplitudes only."""
    import numpy as np  # noqa: PLC0415 - the API and `galloping --help` need no numerics

    from engine.clearance import extents, subconductor_paths  # noqa: PLC0415

    positions = np.array(line.bundle.positions)
    rest, arms = np.ptp(positions, axis=0), np.abs(positions).max(axis=0)[::-1]
    moved = np.array([(row.vertical_m or 0.0, row.horizontal_m or 0.0) for row, _ in motions])
    mean = [0.0 if orbit is None else abs(orbit.torsional[0]) for _, orbit in motions]
    turned = np.array([(row.torsional_rad or 0.0) for row, _ in motions]) + mean
    most, least = (2.0 * (moved + sign * turned[:, None] * arms) for sign in (1.0, -1.0))
    most += rest
    # Orbits that cannot reach as far as another one does anyway need not be followed.
    far = (most >= least.max(axis=0)).any(axis=-1)
    orbits = [orbit for (_, orbit), reaching in zip(motions, far, strict=True) if orbit is not None and reaching]
    found = [rest, *(bound for bound, (_, orbit) in zip(most, motions, strict=True) if orbit is None)]
    if orbits:
        series = np.zeros((len(orbits), 3, max(len(orbit.vertical) for orbit in orbits)))
        for place, orbit in zip(series, orbits, strict=True):
            place[:, : len(orbit.vertical)] = orbit.vertical, orbit.horizontal, orbit.torsional
        found += list(extents(subconductor_paths(series, positions, _PHASES)))
    height, width = np.max(found, axis=0).tolist()
    return height, width
