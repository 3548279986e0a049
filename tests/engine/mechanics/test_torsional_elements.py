"""Derivatives of the energy of the twist against finite differences, and its convexity against eigenvalues."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.mechanics.torsional_elements import TorsionalElements, energy_derivatives, is_convex, torsional_elements
from engine.spec import Bundle, DetuningPendulum, Line
from tests.builders import discretized, source_line
from tests.engine.synthetic_table import with_table


def elements_of(*lines: Line) -> TorsionalElements:
    system = discretized(*lines)
    nodes = system.matrices.stiffness.shape[-1] // 4
    return torsional_elements(
        system.lines, system.profile, system.sections, system.matrices, np.zeros((len(lines), nodes))
    )


def eventful_line() -> Line:
    """Return a bundle off its centroid, with a pendulum at an angle."""
    pendulum = DetuningPendulum(40.0, 3.0, 0.4, 0.3)
    return replace(with_table(source_line(2), 30.0), bundle=Bundle(((0.1, -0.2), (0.05, 0.25))), devices=(pendulum,))


def test_tangent_is_the_derivative_of_the_gradient() -> None:
    elements = elements_of(source_line(3), eventful_line())
    nodes, which = elements.stiffness.shape[-1], np.ones(1, dtype=np.intp)
    speed = np.array([25.0])
    state = np.random.default_rng(0).normal(scale=0.4, size=(1, nodes))

    def gradient(x: FloatArray) -> FloatArray:
        return np.asarray(energy_derivatives(elements, which, speed, x)[0][0])

    steps = 1e-6 * np.eye(nodes)[:, None]
    numerical = np.stack([(gradient(state + step) - gradient(state - step)) / 2e-6 for step in steps])
    tangent = energy_derivatives(elements, which, speed, state)[1][0]
    assert tangent == pytest.approx(tangent.T, abs=1e-9)
    assert numerical == pytest.approx(tangent, abs=1e-6 * np.abs(tangent).max())


def test_still_air_is_an_equilibrium_whose_tangent_is_the_stiffness() -> None:
    elements = elements_of(eventful_line())
    nodes = elements.stiffness.shape[-1]
    gradient, tangent = energy_derivatives(elements, np.zeros(1, dtype=np.intp), np.zeros(1), np.zeros((1, nodes)))
    assert np.abs(gradient).max() < 1e-12
    assert tangent == pytest.approx(elements.stiffness)


def test_no_state_of_a_convex_line_has_a_negative_direction() -> None:
    elements = elements_of(with_table(source_line(2), 20.0), with_table(source_line(1), 20.0), source_line(2))
    assert is_convex(elements, 10.0).tolist() == [True, False, False]
    assert not is_convex(elements, 300.0).any()
    generator = np.random.default_rng(1)
    states = generator.uniform(-4.0, 4.0, (200, elements.stiffness.shape[-1]))
    line = np.zeros(200, dtype=np.intp)
    _, tangent = energy_derivatives(elements, line, np.full(200, 10.0), states)
    assert np.linalg.eigvalsh(tangent[:, 1:-1, 1:-1]).min() > 0.0
    half_waves = np.linspace(-3.0, 3.0, 200)[:, None] * np.sin(np.linspace(0.0, np.pi, states.shape[1]))
    _, tangent = energy_derivatives(elements, line + 1, np.full(200, 10.0), half_waves)
    assert np.linalg.eigvalsh(tangent[:, 1:-1, 1:-1]).min() < 0.0
