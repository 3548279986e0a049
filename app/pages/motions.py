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
    """A limit cycle: its number among the rows, its row, and the Fourier coefficients of its course.

    A page names hundreds of motions and draws one, so a course is computed where it is asked for.
    """

    number: int
    row: Row
    coefficients: Mapping[str, Any]

    @property
    def vertical(self) -> Sequence[float]:
        """Return V over one period [m]."""
        return course(self.coefficients["vertical"])

    @property
    def horizontal(self) -> Sequence[float]:
        """Return W over one period [m]."""
        return course(self.coefficients["horizontal"])

    @property
    def torsional(self) -> Sequence[float]:
        """Return Theta over one period [rad]."""
        return course(self.coefficients["torsional"])

    @property
    def period(self) -> float:
        """Return the duration of the motion [s]."""
        return 1.0 / float(self.row["frequency_hz"])


def motions(session: Session, job: Job, found: Findings) -> list[Motion]:
    """Return the motions of a point whose courses are stored, stable ones first, then by wind speed and size."""
    rows = found.rows("limit_cycles")
    made = [
        Motion(orbit["cycle"], rows[orbit["cycle"]], orbit)
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
    """Return cosine and sine of a harmonic at the times of a course."""
    angles = (2.0 * pi * number * sample / samples for sample in range(samples))
    return tuple((cos(angle), sin(angle)) for angle in angles)


def _order(motion: Motion) -> tuple[bool, float, float]:
    row = motion.row
    return row["stability"] != "stable", row["wind_speed_m_per_s"], -(row["vertical_m"] or 0.0)
