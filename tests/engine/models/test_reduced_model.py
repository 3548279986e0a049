from dataclasses import replace

import numpy as np
import pytest

from engine.models.aerodynamic_load import force
from engine.models.reduced_model import damping_ratios, lowest_frequency, take
from engine.spec import Damping
from tests.builders import Oscillators, hand_made, hybrid, source_line


def test_the_lowest_frequency_is_that_of_the_softest_coordinate_whatever_its_sign() -> None:
    model = hand_made(Oscillators(np.diag([2.0, 1.0]), np.eye(2), np.diag([18.0, 25.0]), {}), copies=2)
    softer = replace(model, stiffness=model.stiffness * np.array([1.0, -4.0])[:, None, None])
    assert lowest_frequency(softer) == pytest.approx([3.0, 6.0])


def test_models_are_picked_and_repeated_with_their_loads() -> None:
    one, other = hybrid(source_line(1)), hybrid(source_line(2))
    twice = take(one, np.array([0, 0]))
    state = np.random.default_rng(3).normal(scale=0.1, size=(2, 5, 6))
    assert force(twice.load, state)[1] == pytest.approx(force(one.load, state[1:])[0])
    assert take(twice, 1).mass == pytest.approx(one.mass[0])
    assert np.abs(force(twice.load, state)[1] - force(other.load, state[1:])[0]).max() > 1e-3


def test_damping_ratios_stand_in_the_order_of_the_directions() -> None:
    lines = [replace(source_line(1), damping=Damping(0.001, 0.002, 0.3)), source_line(2)]
    assert damping_ratios(lines).tolist() == [[0.001, 0.002, 0.3], [0.000515, 0.000515, 0.308]]
