"""The table of model comparisons: hybrid and finite element cycles, as in the source's Figure 3. Theory section 7.4."""

import math
from collections.abc import Sequence

from engine.outcome import Stability
from engine.result import LimitCycleRow, ModelComparisonRow
from engine.spec import Model


def model_comparisons(cycles: Sequence[LimitCycleRow]) -> tuple[ModelComparisonRow, ...]:
    """Compare every stable hybrid cycle with the finite element model's; no rows if only one model was asked for.

    Of several cycles with as many loops at the same wind speed, stable or not, the one with the nearest amplitudes is
    used.
    """
    if Model.FINITE_ELEMENT not in {row.model for row in cycles}:
        return ()
    moving = [row for row in cycles if row.kind == "periodic" and row.vertical_m is not None]
    others = [row for row in moving if row.model is Model.FINITE_ELEMENT]
    alone = [row for row in moving if row.model is Model.HYBRID and row.stability is Stability.STABLE]
    return tuple(_compared(row, others) for row in alone)


def _compared(row: LimitCycleRow, others: Sequence[LimitCycleRow]) -> ModelComparisonRow:
    here = [o for o in others if (o.loops, o.wind_speed_m_per_s) == (row.loops, row.wind_speed_m_per_s)]
    other = min(here, key=lambda o: math.dist(_amplitudes(o), _amplitudes(row)), default=None)
    own = _amplitudes(row)
    found = _amplitudes(other) if other else (None, None, None)
    size = math.hypot(*own[:2])
    return ModelComparisonRow(
        loops=row.loops,
        wind_speed_m_per_s=row.wind_speed_m_per_s,
        branch=row.branch,
        hybrid_vertical_m=own[0],
        hybrid_horizontal_m=own[1],
        hybrid_torsional_rad=own[2],
        finite_element_branch=other.branch if other else None,
        finite_element_stability=other.stability if other else None,
        finite_element_vertical_m=found[0],
        finite_element_horizontal_m=found[1],
        finite_element_torsional_rad=found[2],
        amplitude_difference=math.hypot(*_amplitudes(other)[:2]) / size - 1.0 if other and size else None,
    )


def _amplitudes(row: LimitCycleRow) -> tuple[float, float, float]:
    """Return vertical [m], horizontal [m] and torsional [rad], which every converged cycle has."""
    return row.vertical_m or 0.0, row.horizontal_m or 0.0, row.torsional_rad or 0.0
