"""Free vibration at large amplitude: frequency over amplitude, without wind and damping.

Two horizontal loops of a single conductor, and torsion of a twin bundle.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root

from benchmarks.lines import source_line
from benchmarks.models import discretized
from engine.arrays import FloatArray
from engine.mechanics.modes import directional_shapes, full_modes
from engine.models.finite_element import finite_element_model
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import ReducedModel, take
from engine.models.stretching import restoring_force
from engine.spec import Analysis, CrossSection, Ice, Line, LongitudinalInertia, Stretching, Support, Supports

HARMONICS = 4
SAMPLES = 4 * HARMONICS + 4
HORIZONTAL, TORSIONAL = 1, 2
SMALL = 1e-3  # amplitude of a linear vibration [m]
STEPS = 240  # samples a period of a released bundle
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
BEATING = ("300 m, dead ends", 2.0, 5.35)  # the same of a motion that is not periodic


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


def twin(section: CrossSection) -> Line:
    """Return the source's horizontal twin between dead ends as two chains of bars can be: no torsional rigidity."""
    line, held = source_line(2), Support(dead_end=True)
    return replace(
        line,
        conductor=replace(line.conductor, torsional_rigidity=1e-6, polar_inertia=1e-12),
        bundle=replace(line.bundle, section=section),
        span=replace(line.span, elements=20),
        supports=Supports(None, held, held),
        ice=Ice(line.ice.aerodynamics),
    )


def released_shift(line: Line, loops: int, amplitude: float, periods: int = 24) -> float:
    """Return the relative shift of a twin's frequency when it is released from a sine of Theta, against a small one.

    Parameters
    ----------
    line : Line
    loops : int
    amplitude : float
        Of the sub-conductors, up and down [m].
    periods : int
        Number of periods that are counted, by the zero crossings of the first loop's middle.
    """
    made = discretized([line])
    shapes = directional_shapes(made.matrices, made.profile.arc_length, (1, 2, 3, 5))
    model = take(finite_element_model(made, full_modes(made.matrices, (1, 2, 3, 5)), shapes, ASKED), 0)
    sine = np.sin(loops * math.pi * np.linspace(0.0, 1.0, model.shapes.shape[-1]))
    natural = 0.5 * loops / line.span.length * math.sqrt((line.span.horizontal_tension or 0.0) / line.conductor.mass)
    start = np.zeros((3, sine.size))
    start[TORSIONAL] = sine / abs(line.bundle.positions[0][1])
    shares = np.linalg.lstsq(model.shapes.reshape(len(model.shapes), -1).T, start.ravel(), rcond=None)[0]
    large, small = (
        _released(model, np.asarray(scale * shares, dtype=np.float64), natural, loops, periods, TORSIONAL)
        for scale in (amplitude, SMALL)
    )
    return large / small - 1.0


def swinging_shifts(line: Line, amplitude: float, periods: int = 24) -> tuple[float, float]:
    """Return the relative shifts of two horizontal loops that are released, in the hybrid and finite element model.

    Where the tension swings by more than half, the motion beats: it has this mean frequency, over a number of periods
    by the zero crossings of the first loop's middle, and no single one.
    """
    made, loops = discretized([line]), (1, 2, 3, 5)
    shapes = directional_shapes(made.matrices, made.profile.arc_length, loops)
    hybrid = take(hybrid_model(made, shapes, (2,), ASKED), (0, 0))
    finite_element = take(finite_element_model(made, full_modes(made.matrices, loops), shapes, ASKED), 0)
    second = finite_element.direction.tolist().index(HORIZONTAL) + loops.index(2)
    return (
        _swinging_shift(hybrid, HORIZONTAL, amplitude, periods),
        _swinging_shift(finite_element, second, amplitude, periods),
    )


def _swinging_shift(model: ReducedModel, coordinate: int, amplitude: float, periods: int) -> float:
    natural = math.sqrt(model.stiffness[coordinate, coordinate] / model.mass[coordinate, coordinate]) / (2.0 * math.pi)
    start = np.zeros(model.mass.shape[-1])
    start[coordinate] = 1.0 / float(np.abs(model.shapes[coordinate, HORIZONTAL]).max())
    large, small = (_released(model, scale * start, natural, 2, periods, HORIZONTAL) for scale in (amplitude, SMALL))
    return large / small - 1.0


def _released(
    model: ReducedModel, start: FloatArray, natural: float, loops: int, periods: int, direction: int
) -> float:
    """Integrate from rest and return the mean frequency of a direction in the middle of the first loop [Hz]."""
    assert model.stretching is not None
    stretching, m, inverse = model.stretching, start.size, np.linalg.inv(model.mass)

    def rate(_: float, y: FloatArray) -> FloatArray:
        return np.append(y[m:], -inverse @ (model.stiffness @ y[:m] + restoring_force(stretching, y[None, :m])[0]))

    times = np.arange(1, (periods + 1) * STEPS + 1) / (natural * STEPS)
    y = np.append(start, np.zeros(m))
    solution = solve_ivp(rate, (0.0, times[-1]), y, method="DOP853", t_eval=times, rtol=1e-9, atol=1e-10)
    middle = round((model.shapes.shape[-1] - 1) / (2 * loops))
    return mean_frequency(solution.y[:m].T @ model.shapes[:, direction, middle], natural * STEPS)


def mean_frequency(series: FloatArray, rate: float) -> float:
    """Return the mean frequency between the first and the last upward zero crossing of samples at a rate [Hz]."""
    upward = np.flatnonzero((series[:-1] < 0.0) & (series[1:] >= 0.0))
    crossing = upward + series[upward] / (series[upward] - series[upward + 1])
    return float((upward.size - 1) / (crossing[-1] - crossing[0]) * rate)
