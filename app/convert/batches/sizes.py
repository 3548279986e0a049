"""Estimate the stored bytes of results from measured ones, by what their analysis asks for."""

import math
from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from app import schemas

# Bytes as stored, rounded from packed results of the source's lines: for a line, and for each motion that is asked for,
# which is a wind speed with a number of loops in a model. A motion has an orbit, whose bytes follow the harmonics.
_LINE = 3500
_MOTION = 270
_HARMONIC_OF_MOTION = 65


def bytes_a_line(analysis: schemas.Analysis) -> int:
    """Estimate the stored bytes of a line's results.

    Lines whose every motion is one cycle take so much. Those that do not gallop take down to a fifth of it, those with
    many motions beside each other up to five times as much.
    """
    loops = len(analysis.loops) if "hybrid" in analysis.models else 0
    loops += len(analysis.finite_element_loops) if "finite_element" in analysis.models else 0
    motion = _MOTION + _HARMONIC_OF_MOTION * analysis.harmonics
    return _LINE + motion * loops * len(analysis.speeds())


def expected_bytes(document: Mapping[str, Any]) -> int:
    """Estimate the stored bytes of the results of a request; one of an earlier version counts as if of defaults."""
    try:
        analysis = schemas.Analysis.model_validate(document.get("analysis", {}))
    except ValidationError:
        analysis = schemas.Analysis()
    axes = document.get("study", {}).get("axes", ())
    return bytes_a_line(analysis) * math.prod(len(axis["values"]) for axis in axes)
