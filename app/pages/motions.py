"""The periodic motions of a result, with their courses over one period at the place where they are observed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from math import cos, pi, sin
from typing import Any

from sqlalchemy.orm import Session

from app.pages.findings import Findings, Row
from app.storage import stored_results
from app.tables import Job

SAMPLES = 60


@dataclass(frozen=True, slots=True)
class Motion:
    """A limit cycle: its number among the rows, its row, and V, W [m] and Theta [rad] over one period."""

    number: int
    row: Row
    vertical: Sequence[float]
    horizontal: Sequence[float]
    torsional: Sequence[float]

    @property
    def period(self) -> float:
        """Return the duration of the motion [s]."""
        return 1.0 / float(self.row["frequency_hz"])


def motions(session: Session, job: Job, found: Findings) -> list[Motion]:
    """Return the motions of a point whose courses are stored, stable ones first, then by wind speed and size."""
    rows = found.rows("limit_cycles")
    made = [
        motion_of(orbit, rows[orbit["cycle"]])
        for orbit in stored_results.orbits(session, job.id)
        if orbit["point"] == found.point
    ]
    return sorted(made, key=_order)


def worst(made: Sequence[Motion]) -> Motion | None:
    """Return the stable motion of the largest vertical amplitude, which the verdict is about; None if none is."""
    stable = [motion for motion in made if motion.row["stability"] == "stable"]
    return max(stable, key=lambda motion: motion.row["vertical_m"] or 0.0, default=None)


def course(coefficients: Sequence[float], samples: int = SAMPLES) -> list[float]:
    """Return a Fourier series (mean, cos 1, sin 1, cos 2, ...) at evenly spaced times of one period."""
    values = [coefficients[0]] * samples
    waves = zip(coefficients[1::2], coefficients[2::2], strict=True)
    for number, (a, b) in enumerate(waves, start=1):
        values = [value + a * c + b * s for value, (c, s) in zip(values, _wave(number, samples), strict=True)]
    return values


@cache
def _wave(number: int, samples: int) -> tuple[tuple[float, float], ...]:
    """Return cosine and sine of a harmonic at the times of a course; a page has hundreds of courses."""
    angles = (2.0 * pi * number * sample / samples for sample in range(samples))
    return tuple((cos(angle), sin(angle)) for angle in angles)


def motion_of(orbit: Mapping[str, Any], row: Row) -> Motion:
    """Return the motion with the stored coefficients of its course."""
    return Motion(orbit["cycle"], row, *(course(orbit[name]) for name in ("vertical", "horizontal", "torsional")))


def _order(motion: Motion) -> tuple[bool, float, float]:
    row = motion.row
    return row["stability"] != "stable", row["wind_speed_m_per_s"], -(row["vertical_m"] or 0.0)
