"""Static twist in the wind against the figures of theory section 14, a beam, and finite differences of the energy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_bvp

from engine.arrays import FloatArray
from engine.mechanics.torsional_elements import TorsionalElements, torsional_elements
from engine.mechanics.wind_twist import WindTwist, equilibria, wind_twist
from engine.outcome import Outcome
from engine.spec import Bundle, DetuningPendulum, Line
from tests.builders import discretized, source_line
from tests.engine.synthetic_table import overturning_line, series, with_table

RISING = np.array([4.0, 10.0, 20.0])


def elements_of(*lines: Line) -> TorsionalElements:
    """Return the torsional elements of lines whose state in still air is the given one."""
    system = discretized(*lines)
    nodes = system.matrices.stiffness.shape[-1] // 4
    return torsional_elements(
        system.lines, system.profile, system.sections, system.matrices, np.zeros((len(lines), nodes))
    )


def followed(winds: FloatArray, *lines: Line) -> WindTwist:
    return wind_twist(elements_of(*lines), winds, np.ones(len(lines), dtype=np.bool_))


def at_mid_span(angle: FloatArray) -> FloatArray:
    """Return the twist at mid-span [deg] of nodes on the last axis."""
    return np.degrees(angle[..., angle.shape[-1] // 2])


@pytest.mark.parametrize(
    ("subconductors", "static_angle", "expected"),
    [
        (2, 20.0, (-0.0068, -0.0436, -0.1877)),
        (2, 40.0, (0.1228, 0.785, 3.388)),
        (1, 20.0, (-1.693, -15.44, -20.67)),
        (1, -20.0, (4.473, 17.60, 21.57)),
    ],
)
def test_twist_at_mid_span_is_that_of_section_14(
    subconductors: int, static_angle: float, expected: tuple[float, ...]
) -> None:
    twist = followed(RISING, with_table(source_line(subconductors), static_angle))
    assert set(twist.outcome.ravel()) == {Outcome.CONVERGED}
    assert twist.fold_line.size == 0
    assert at_mid_span(twist.angle[0]) == pytest.approx(np.array(expected), rel=2e-3, abs=1e-4)


def test_twist_of_a_single_conductor_is_that_of_a_beam_in_torsion() -> None:
    """GJ Theta'' + 1/2 rho d^2 U^2 C_M + m g (e_y sin Theta + e_z (cos Theta - 1)) = 0, by scipy's collocation."""
    line = source_line(1)
    twist = followed(np.array([20.0]), with_table(line, 20.0))
    arc = float(discretized(line).profile.arc_length[0])
    conductor, weight = line.conductor, line.conductor.mass * 9.81
    pressure = 0.5 * line.wind.air_density * conductor.diameter**2 * 400.0

    def slope(_: FloatArray, y: FloatArray) -> FloatArray:
        moment = pressure * series("cm", math.radians(20.0) + y[0])[0]
        moment += weight * (line.ice.eccentricity_y * np.sin(y[0]) + line.ice.eccentricity_z * (np.cos(y[0]) - 1.0))
        return np.stack([y[1], -moment / conductor.torsional_rigidity])

    nodes = np.linspace(0.0, arc, twist.angle.shape[-1])
    guess = np.stack([twist.angle[0, 0], np.gradient(twist.angle[0, 0], nodes)])
    exact = solve_bvp(slope, lambda a, b: np.array([a[0], b[0]]), nodes, guess, tol=1e-8)
    assert exact.success
    assert twist.angle[0, 0] == pytest.approx(exact.sol(nodes)[0], rel=2e-3, abs=2e-4)


def test_small_steps_and_large_ones_lead_to_the_same_state() -> None:
    line = with_table(source_line(1), -20.0)
    fine = followed(np.linspace(0.25, 20.0, 80), line)
    assert fine.angle[0, -1] == pytest.approx(followed(RISING, line).angle[0, -1], abs=1e-9)


def test_found_states_are_minima_of_one_energy() -> None:
    """The gradient vanishes, and the tangent is its derivative: a state moved a little costs energy."""
    pendulum = DetuningPendulum(40.0, 3.0, 0.4, 0.3)
    line = replace(with_table(source_line(2), 30.0), bundle=Bundle(((0.1, -0.2), (0.05, 0.25))), devices=(pendulum,))
    elements = elements_of(line, line)
    speeds = np.array([15.0, 15.0])
    which = np.arange(2)
    state, found = equilibria(elements, which, speeds, np.zeros((2, elements.stiffness.shape[-1])))
    assert found.all()
    # From anywhere near, the same state is found.
    generator = np.random.default_rng(0)
    start = state + generator.normal(scale=0.05, size=state.shape) * (np.arange(state.shape[1]) % 20 > 0)
    again, _ = equilibria(elements, which, speeds, start)
    assert again == pytest.approx(state, abs=1e-9)
    assert np.abs(state).max() > 1e-3


def test_a_soft_conductor_has_further_equilibria_and_a_stiff_bundle_none() -> None:
    soft = with_table(source_line(1), 20.0)
    twist = followed(np.array([5.0, 10.0]), soft, with_table(source_line(2), 20.0))
    assert set(twist.further_line.tolist()) == {0}
    elements, zero = elements_of(soft), np.zeros(1, dtype=np.intp)
    for wind, one in zip(twist.further_wind, twist.further_angle, strict=True):
        again, stable = equilibria(elements, zero, np.array([5.0, 10.0])[[wind]], one[None] + 1e-3)
        assert stable.all()
        assert np.abs(again[0] - one).max() < 1e-6
        assert np.abs(one - twist.angle[0, wind]).max() > 0.1
    assert 91.0 < at_mid_span(twist.further_angle[twist.further_wind == 1])[0] < 92.0


def test_lines_that_are_not_asked_for_are_left_out() -> None:
    lines = (with_table(source_line(1), 20.0), with_table(source_line(1), -20.0))
    one = wind_twist(elements_of(*lines), RISING, np.array([False, True]))
    both = followed(RISING, *lines)
    assert np.isnan(one.angle[0]).all()
    assert one.angle[1] == pytest.approx(both.angle[1], abs=1e-10)
    assert set(one.further_line.tolist()) <= {1}


def test_a_state_that_ends_in_a_fold_is_left_for_another_one_and_the_fold_is_reported() -> None:
    """The fold is where GJ Theta'' + 1/2 rho d^2 U^2 C_M has no small solution any more, by shooting from mid-span."""
    line = overturning_line()
    arc = float(discretized(line).profile.arc_length[0])
    pressure = 0.5 * line.wind.air_density * line.conductor.diameter**2 / line.conductor.torsional_rigidity

    def fold() -> float:
        """U as a function of the twist at mid-span has its first maximum at the fold: time of fall in a potential."""
        largest = np.linspace(0.2, 1.4, 61)
        half = [
            quad(
                lambda u, top=top: 2.0 * u / math.sqrt(2.0 * (potential(top) - potential(top - u * u))),
                0.0,
                math.sqrt(top),
            )[0]
            for top in largest
        ]
        speed = np.array(half) / (0.5 * arc * math.sqrt(pressure))
        return float(speed.max())

    def potential(theta: float) -> float:
        return 0.6 * theta - 0.5 * math.sin(theta)

    twist = followed(np.arange(14.0, 31.0), line)
    assert twist.fold_wind_speed == pytest.approx([fold()], rel=3e-3)
    middle = np.radians(at_mid_span(twist.angle[0]))
    place = int(np.searchsorted(np.arange(14.0, 31.0), twist.fold_wind_speed[0]))
    assert middle[place - 1] < 1.0
    assert middle[place] > 2.0


def test_a_line_that_cannot_hang_as_given_is_statically_unstable() -> None:
    line = with_table(replace(source_line(1), span=replace(source_line(1).span, length=300.0)), 20.0)
    twist = followed(RISING, line, with_table(source_line(1), 20.0))
    assert set(twist.outcome[0]) == {Outcome.STATICALLY_UNSTABLE}
    assert np.isnan(twist.angle[0]).all()
    assert set(twist.outcome[1]) == {Outcome.CONVERGED}
