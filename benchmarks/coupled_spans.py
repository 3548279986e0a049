"""Two spans with a spring between them, integrated in time: tied phases without the machinery of assemblies."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.finite_elements import interpolation_at
from engine.mechanics.modes import directional_shapes, full_modes
from engine.models.discretization import discretize
from engine.models.finite_element import finite_element_model
from engine.models.reduced_model import resultant
from engine.spec import Analysis, Line

LAST = 50.0  # seconds at the end that are returned


@dataclass(frozen=True, slots=True)
class Spring:
    """A spring between two spans at a position [m] along an axis (y, z), with a stiffness [N/m]."""

    position: float
    axis: tuple[float, float]
    stiffness: float


def middle_motion(
    lines: tuple[Line, Line], spring: Spring, loops: int, wind: float, run: tuple[tuple[float, float], float]
) -> tuple[FloatArray, float]:
    """Integrate two spans by Runge and Kutta's method, each with the modes of one to so many loops.

    Parameters
    ----------
    lines : pair of Line
        Single spans of equal numbers of elements.
    spring : Spring
    loops : int
        Modes of single spans approach the kink at the spring slowly.
    wind : float
        Wind speed [m/s].
    run : tuple
        V of both in the middle at the start [m], in one loop, and the duration [s].

    Returns
    -------
    series : (samples, 2)
        V of both in the middle over the last `LAST` seconds [m].
    step : float
        [s]
    """
    both = discretize(lines)
    numbers = tuple(range(1, loops + 1))
    shapes = directional_shapes(both.matrices, both.profile.arc_length, numbers)
    model = finite_element_model(both, full_modes(both.matrices, numbers), shapes, Analysis())
    link = np.zeros(model.mass.shape[:2])
    elements = lines[0].span.elements
    for i, sign in enumerate((-1.0, 1.0)):
        first, values = interpolation_at(both.profile, i, elements, spring.position)
        v, w = np.moveaxis(model.shapes[i, :, :2, first : first + 3] @ values, -1, 0)
        link[i] = sign * (spring.axis[0] * v + spring.axis[1] * w)
    winds = np.full(2, wind)

    def acceleration(q: FloatArray, rate: FloatArray) -> FloatArray:
        load = wind**2 * resultant(model, np.concatenate([q, rate / wind], axis=-1)[:, None], winds)[:, 0]
        resisted = (model.damping @ rate[..., None] + model.stiffness @ q[..., None])[..., 0]
        return np.asarray(load - resisted - spring.stiffness * (link * q).sum() * link)

    start, duration = run
    middle = model.shapes[:, :, 0, elements]
    q, rate = np.zeros((2, *model.mass.shape[:2]))
    q[:, 0] = np.array(start) / middle[:, 0]
    h = 1.2 / float(np.sqrt(np.linalg.eigvalsh(model.stiffness).max()))
    series = []
    for _ in range(int(duration / h)):
        a = acceleration(q, rate)
        b = acceleration(q + 0.5 * h * rate, rate + 0.5 * h * a)
        c = acceleration(q + 0.5 * h * rate + 0.25 * h * h * a, rate + 0.5 * h * b)
        d = acceleration(q + h * rate + 0.5 * h * h * b, rate + h * c)
        q, rate = q + h * rate + h * h / 6.0 * (a + b + c), rate + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
        series.append((q * middle).sum(axis=-1))
    return np.array(series[-int(LAST / h) :]), h
