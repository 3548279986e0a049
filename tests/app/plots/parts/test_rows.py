import math

import numpy as np

from app.plots.parts.rows import loops_and_models, loops_name, motion, orbits_of, spread
from tests.app.plots.drawn_motions import NO_MOTIONS, motions


def test_the_motion_is_the_sum_of_its_harmonics() -> None:
    phase = np.linspace(0.0, 2.0 * math.pi, 361)
    expected = 0.1 + 0.2 * np.cos(phase) - 0.3 * np.sin(phase) + 0.04 * np.cos(2 * phase) + 0.05 * np.sin(2 * phase)
    np.testing.assert_allclose(motion([0.1, 0.2, -0.3, 0.04, 0.05]), expected, atol=1e-14)
    np.testing.assert_allclose(motion([0.7]), np.full(361, 0.7))


def test_loops_and_models_are_those_of_the_rows() -> None:
    assert loops_and_models(motions(loops=(3, 1))) == ([1, 3], ["hybrid", "finite_element"])
    assert loops_and_models(NO_MOTIONS) == ([1], ["hybrid"])
    assert [loops_name(1), loops_name(2), loops_name(2, of_section=True)] == ["1 loop", "2 loops", "mode 2"]


def test_orbits_come_with_their_cycles() -> None:
    assert all(cycle["stability"] == "stable" for cycle, _ in orbits_of(motions()))


def test_values_are_thinned_evenly_with_both_ends() -> None:
    assert spread([1, 2, 3], 3) == [1, 2, 3]
    assert spread(list(range(41)), 5) == [0, 10, 20, 30, 40]
