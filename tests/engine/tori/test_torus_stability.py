"""Verdicts on tori against the exponents of the slow equations of their amplitudes."""

import numpy as np
import pytest

from engine.outcome import Stability
from engine.tori.torus_stability import torus_stability
from tests.engine.coupled_circles import FREQUENCIES, GROWTHS, circle_radii, coupled_circles, two_lines


# d(r_i^2)/dt = mu_i r_i^2 (1 - r_i^2 - c_i r_j^2): unstable where c_1 c_2 > 1.
@pytest.mark.parametrize(
    ("coupling", "expected"),
    [((0.5, 0.5), Stability.STABLE), ((0.4, 0.8), Stability.STABLE), ((1.5, 1.6), Stability.UNSTABLE)],
)
def test_growth_across_an_exact_torus(coupling: tuple[float, float], expected: Stability) -> None:
    radii = circle_radii(coupling)
    judged = torus_stability(coupled_circles(coupling), two_lines(radii, FREQUENCIES, (2, 2)))
    assert judged.stability is expected
    slow = np.array([[1.0, coupling[0]], [coupling[1], 1.0]])
    exponents = np.linalg.eigvals(-np.array(GROWTHS)[:, None] * np.square(radii)[:, None] * slow)
    rate = np.log(judged.largest) / (judged.periods * 2.0 * np.pi / FREQUENCIES[0])
    # The slow equations are of first order in the growth, and the torus returns to within some hundredths.
    assert rate == pytest.approx(exponents.max(), rel=0.03)


def test_a_torus_that_is_none_is_not_judged() -> None:
    judged = torus_stability(coupled_circles((0.5, 0.5)), two_lines((1.0, 0.0), FREQUENCIES, (2, 2)))
    assert judged.stability is Stability.UNKNOWN


def test_a_motion_that_does_not_solve_the_equations_is_not_judged_stable() -> None:
    radii = circle_radii((0.5, 0.5))
    wrong = two_lines((1.3 * radii[0], 0.7 * radii[1]), (1.0, 1.36), (2, 2))
    assert torus_stability(coupled_circles((0.5, 0.5)), wrong).stability is not Stability.STABLE
