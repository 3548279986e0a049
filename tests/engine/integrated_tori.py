"""Direct integration from a torus, to hold the two-frequency balance against."""

import numpy as np
from scipy.integrate import solve_ivp

from engine.arrays import FloatArray
from engine.models.aerodynamic_load import force
from engine.models.reduced_model import ReducedModel, take
from engine.tori.two_frequency_balance import Tori, states


def followed(model: ReducedModel, torus: Tori, periods: float) -> tuple[FloatArray, FloatArray]:
    """Integrate from a torus, and evaluate it at the same times: (samples, 2 m) each, of q and q'."""
    speed, m = float(torus.wind_speed[0]), model.mass.shape[-1]
    inverse = np.linalg.inv(model.mass[0])

    def rate(_: float, y: FloatArray) -> FloatArray:
        load = force(take(model, 0).load, np.append(y[:m], y[m:] / speed)[None])[0]
        return np.append(y[m:], inverse @ (speed**2 * load - model.stiffness[0] @ y[:m] - model.damping[0] @ y[m:]))

    times = np.linspace(0.0, periods * 2.0 * np.pi / torus.angular_frequency[0, 0], 200)
    expected = states(torus, times[:, None] * torus.angular_frequency[0])[0] * np.repeat([1.0, speed], m)
    run = solve_ivp(rate, (0.0, times[-1]), expected[0], method="DOP853", t_eval=times, rtol=1e-9, atol=1e-11)
    return run.y.T, expected
