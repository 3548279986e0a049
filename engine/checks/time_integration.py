"""Direct integration of the reduced equations, a check that a user can ask for. Theory section 7.5."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from engine.arrays import FloatArray
from engine.cycles.harmonic_balance import Orbits, states
from engine.models.reduced_model import ReducedModel, resultant
from engine.outcome import Outcome

SAMPLES = 64  # a cycle
PERIOD_SAMPLES = 192  # of the one period that is measured; the error is 1e-4 of the amplitude
BLOCK = 50  # cycles between two comparisons of the amplitude


@dataclass(frozen=True, slots=True)
class IntegratedMotion:
    """The motion that direct integration ended on.

    extremes: (m, 2), smallest and largest value of each coordinate over the last block; state: (2 m,), (q, q') at the
    end; cycles: number of cycles integrated; outcome: LIMIT_REACHED if the amplitude was still changing; history:
    (samples, m), the coordinates over the last block.
    """

    extremes: FloatArray
    state: FloatArray
    cycles: int
    outcome: Outcome
    history: FloatArray

    @property
    def amplitude(self) -> FloatArray:
        """Half of the peak-to-peak of each coordinate, (m,)."""
        return np.asarray(0.5 * (self.extremes[:, 1] - self.extremes[:, 0]))


def integrate(
    model: ReducedModel, wind_speed: float, start: FloatArray, *, change: float = 1e-4, longest: int = 20_000
) -> IntegratedMotion:
    """Integrate until no coordinate's amplitude changes by more than a fraction over a block of 50 cycles.

    Parameters
    ----------
    model : ReducedModel
        A single model, without leading axes.
    wind_speed : float
        [m/s].
    start : (2 m,)
        q and q'.
    change : float
        Largest relative change of an amplitude between two successive blocks.
    longest : int
        Number of cycles after which the integration stops in any case.

    Returns
    -------
    IntegratedMotion
    """
    period = 2.0 * np.pi / _slowest(model)
    times = np.linspace(0.0, BLOCK * period, BLOCK * SAMPLES + 1)
    state, before = start, np.full(model.mass.shape[-1], np.inf)
    for block in range(1, longest // BLOCK + 1):
        history = _advance(model, wind_speed, state, times)
        state = history[-1]
        m = before.size
        extremes = np.stack([history[:, :m].min(axis=0), history[:, :m].max(axis=0)], axis=-1)
        amplitude = 0.5 * (extremes[:, 1] - extremes[:, 0])
        if not np.isfinite(amplitude).all():
            break
        if (np.abs(amplitude - before) <= change * amplitude).all():
            return IntegratedMotion(extremes, state, block * BLOCK, Outcome.CONVERGED, history[:, :m])
        before = amplitude
    return IntegratedMotion(extremes, state, block * BLOCK, Outcome.LIMIT_REACHED, history[:, :m])


def amplitude_after_periods(model: ReducedModel, orbit: Orbits, periods: int) -> FloatArray:
    """Integrate from a cycle for a number of its periods and return the amplitudes over the last one.

    Parameters
    ----------
    model : ReducedModel
        A single model, without leading axes.
    orbit : Orbits
        A single cycle.
    periods : int

    Returns
    -------
    (m,)
        Half of the peak-to-peak of each coordinate.
    """
    m = model.mass.shape[-1]
    wind, period = float(orbit.wind_speed[0]), 2.0 * np.pi / float(orbit.angular_frequency[0])
    start = states(orbit, np.zeros(1))[0, 0] * np.repeat([1.0, wind], m)
    return np.asarray(0.5 * np.ptp(last_period(model, wind, start, last_times(period, periods)), axis=0))


def last_times(period: float, periods: int) -> FloatArray:
    """Return the times of the samples of the last of a number of periods [s]."""
    return np.asarray(period * (periods - 1.0 + np.arange(PERIOD_SAMPLES + 1) / PERIOD_SAMPLES))


def last_period(model: ReducedModel, wind_speed: float, start: FloatArray, times: FloatArray) -> FloatArray:
    """Integrate from (q, q') at time 0 and return q at the given later times: (times, m)."""
    return _advance(model, wind_speed, start, np.append(0.0, times))[1:, : model.mass.shape[-1]]


def _slowest(model: ReducedModel) -> float:
    rates = np.linalg.eigvals(np.linalg.solve(model.mass, model.stiffness)).real
    return float(np.sqrt(rates.min()))


def _advance(model: ReducedModel, wind_speed: float, state: FloatArray, times: FloatArray) -> FloatArray:
    m = model.mass.shape[-1]
    inverse = np.linalg.inv(model.mass)
    stiffness, damping = inverse @ model.stiffness, inverse @ model.damping

    def rate(_: float, y: FloatArray) -> FloatArray:
        q, velocity = y[:m], y[m:]
        load = resultant(model, np.concatenate([q, velocity / wind_speed])[None], np.array(wind_speed))[0]
        acceleration = wind_speed**2 * (inverse @ load) - stiffness @ q - damping @ velocity
        return np.concatenate([velocity, acceleration])

    result = solve_ivp(rate, (0.0, times[-1]), state, method="DOP853", t_eval=times, rtol=1e-8, atol=1e-10)
    return np.asarray(result.y.T)
