import math

import numpy as np

from app.plots.orbits import _motion


def test_the_motion_is_the_sum_of_its_harmonics() -> None:
    phase = np.linspace(0.0, 2.0 * math.pi, 361)
    expected = 0.1 + 0.2 * np.cos(phase) - 0.3 * np.sin(phase) + 0.04 * np.cos(2 * phase) + 0.05 * np.sin(2 * phase)
    np.testing.assert_allclose(_motion([0.1, 0.2, -0.3, 0.04, 0.05]), expected, atol=1e-14)
    np.testing.assert_allclose(_motion([0.7]), np.full(361, 0.7))
