"""Free vibration in two horizontal loops at large amplitude: frequency over amplitude, without wind and damping."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.optimize import root

from benchmarks.lines import source_line
from benchmarks.models import discretized
from engine.arrays import FloatArray
from engine.mechanics.modes import directional_shapes, full_modes
from engine.models.finite_element import finite_element_model
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import ReducedModel, take
from engine.models.stretching import restoring_force
from engine.spec import Analysis, Ice, Line, LongitudinalInertia, Stretching, Support, Supports

HARMONICS = 4
SAMPLES = 4 * HARMONICS + 4
HORIZONTAL = 1
ASKED = Analysis(longitudinal_inertia=LongitudinalInertia.CONDENSED, stretching=Stretching.INCLUDED)


def _span(length: float | None, stiffness: float | None) -> Line:
    """Return the source's single conductor, ice not eccentric; a length [m] has 3 % of sag, no stiffness dead ends."""
    line = source_line(1)
    geometry = line.span
    if length is not None:
        geometry = replace(geometry, length=length, horizontal_tension=None, sag=0.03 * length)
    held = Support(dead_end=True)
    supports = Supports(None, held, held) if stiffness is None else Supports(stiffness)
    return replace(line, span=replace(geometry, elements=20), supports=supports, ice=Ice(line.ice.aerodynamics))


SPANS: Mapping[str, Line] = {
    "source's line, springs": _span(None, 1.285e5),
    "source's line, dead ends": _span(None, None),
    "300 m, springs": _span(300.0, 1.2e5),
    "300 m, dead ends": _span(300.0, None),
}
EXACT_SHIFTS = (  # theory section 12.1: span, amplitude [m], shift of an exact chain of bars [%]
    ("source's line, springs", 0.36, 0.571),
    ("source's line, springs", 0.95, 3.920),
    ("source's line, dead ends", 0.36, 2.083),
    ("source's line, dead ends", 0.95, 14.00),
    ("300 m, springs", 1.0, 0.957),
    ("300 m, springs", 3.0, 8.27),
    ("300 m, dead ends", 1.0, 2.41),
)


def hybrid_shift(line: Line, amplitude: float) -> float:
    """Return the relative shift of two horizontal loops of an amplitude [m] in the hybrid model."""
    made = discretized([line])
    shapes = directional_shapes(made.matrices, made.profile.arc_length, (1, 2))
    return frequency_shift(take(hybrid_model(made, shapes, (2,), ASKED), (0, 0)), HORIZONTAL, amplitude)


def finite_element_shift(line: Line, amplitude: float, loops: tuple[int, ...] = (1, 2, 3, 5)) -> float:
    """Return the same in the finite element model with the modes of these loops, two among them."""
    made = discretized([line])
    shapes = directional_shapes(made.matrices, made.profile.arc_length, tuple(sorted({1, *loops})))
    model = take(finite_element_model(made, full_modes(made.matrices, loops), shapes, ASKED), 0)
    coordinate = model.direction.tolist().index(HORIZONTAL) + loops.index(2)
    return frequency_shift(model, coordinate, amplitude / float(np.abs(model.shapes[coordinate, HORIZONTAL]).max()))


def frequency_shift(model: ReducedModel, coordinate: int, amplitude: float) -> float:
    """Return by how much a coordinate's frequency rises, relatively, when it swings with an amplitude.

    Parameters
    ----------
    model : ReducedModel
        A single model, without leading axes, with stretching.
    coordinate : int
        The coordinate that swings.
    amplitude : float
        Its size at the start, when everything is at rest.

    Raises
    ------
    RuntimeError
        If the periodic motion is not found.
    """
    small = _frequency(model, coordinate, 1e-4)
    return _frequency(model, coordinate, amplitude) / small - 1.0


def _frequency(model: ReducedModel, coordinate: int, amplitude: float) -> float:
    """Solve for the motion that is even in time, by harmonic balance with cosines only [Hz]."""
    assert model.stretching is not None
    stretching, m = model.stretching, model.mass.shape[-1]
    order = np.arange(HARMONICS + 1)
    values = np.cos(np.outer(2.0 * math.pi * np.arange(SAMPLES) / SAMPLES, order))
    projection = values.T * np.where(order == 0, 1.0, 2.0)[:, None] / SAMPLES
    natural = math.sqrt(model.stiffness[coordinate, coordinate] / model.mass[coordinate, coordinate])
    scale = model.stiffness[coordinate, coordinate] * amplitude

    def residual(x: FloatArray) -> FloatArray:
        q, omega = x[:-1].reshape(m, -1), x[-1] * natural
        inertia = model.mass @ (q * (order * omega) ** 2)
        restoring = (projection @ restoring_force(stretching, (q @ values.T).T)).T
        balance = model.stiffness @ q + restoring - inertia
        return np.append(balance.ravel() / scale, q[coordinate].sum() / amplitude - 1.0)

    start = np.zeros((m, order.size))
    start[coordinate, 1] = amplitude
    solution = root(residual, np.append(start.ravel(), 1.0), tol=1e-13)
    if not np.abs(residual(solution.x)).max() < 1e-9:
        raise RuntimeError(f"no periodic motion of amplitude {amplitude}: {solution.message}")
    return float(solution.x[-1] * natural / (2.0 * math.pi))
