"""The synthetic table of theory section 14: Fourier series of order 7 with the source's coefficients at angle zero."""

import json
import math
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.coefficients import fit_measured
from engine.spec import Aerodynamics, Line, MeasuredCoefficients
from tests.builders import source_line

PATH = Path(__file__).parent / "data" / "table_c11_like.json"


@lru_cache
def synthetic() -> dict[str, Any]:
    """Return the document of the table."""
    document: dict[str, Any] = json.loads(PATH.read_text(encoding="utf-8"))
    return document


def measured(static_angle_deg: float, half_range_deg: float = 20.0) -> MeasuredCoefficients:
    """Return the table with a section that rests at an angle."""
    document = synthetic()
    angle = tuple(math.radians(a) for a in document["angle_deg"])
    lift, drag, moment = (tuple(document[name]) for name in ("cl", "cd", "cm"))
    return MeasuredCoefficients(angle, lift, drag, moment, math.radians(static_angle_deg), math.radians(half_range_deg))


def tabulated(static_angle_deg: float) -> Aerodynamics:
    """Return the coefficients of that table."""
    return fit_measured(measured(static_angle_deg))


def with_table(line: Line, static_angle_deg: float) -> Line:
    """Return a line whose ice has the table, at rest at an angle."""
    return replace(line, ice=replace(line.ice, aerodynamics=tabulated(static_angle_deg)))


def series(name: str, angle: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a coefficient at angles [rad] and its slope, by the Fourier series behind the table."""
    terms = synthetic()["fourier"][name]
    order = np.arange(1, len(terms["cos"]) + 1)
    cosine, sine = np.cos(order * angle[..., None]), np.sin(order * angle[..., None])
    value = terms["mean"] + cosine @ terms["cos"] + sine @ terms["sin"]
    return value, (order * cosine) @ terms["sin"] - (order * sine) @ terms["cos"]


def overturning_line() -> Line:
    """Return a line without eccentricity whose moment grows with the twist and turns it over near 19 m/s."""
    line = source_line(1)
    angle = np.radians(np.arange(-180.0, 181.0, 2.0))
    moment = 0.1 + 0.5 * (1.0 - np.cos(angle))
    none, one = (0.0,) * angle.size, (1.0,) * angle.size
    table = replace(measured(0.0), angle=tuple(angle.tolist()), lift=none, drag=one, moment=tuple(moment.tolist()))
    return replace(
        line, ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0, aerodynamics=fit_measured(table))
    )
