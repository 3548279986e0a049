"""The periodic motions of a result, with their courses over one period at the place where they are observed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
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
        _motion(orbit, rows[orbit["cycle"]])
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
    mean, rest = coefficients[0], coefficients[1:]
    waves = list(zip(rest[::2], rest[1::2], strict=True))
    angles = [2.0 * pi * number / samples for number in range(samples)]
    return [
        mean + sum(a * cos(k * angle) + b * sin(k * angle) for k, (a, b) in enumerate(waves, start=1))
        for angle in angles
    ]


def _motion(orbit: Mapping[str, Any], row: Row) -> Motion:
    return Motion(orbit["cycle"], row, *(course(orbit[name]) for name in ("vertical", "horizontal", "torsional")))


def _order(motion: Motion) -> tuple[bool, float, float]:
    row = motion.row
    return row["stability"] != "stable", row["wind_speed_m_per_s"], -(row["vertical_m"] or 0.0)
