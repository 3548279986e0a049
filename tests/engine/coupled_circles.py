"""Oscillators whose quasi-periodic motions are known, for the tests of tori."""

import numpy as np

from engine.models.reduced_model import ReducedModel
from engine.tori.two_frequency_balance import Order, Tori, harmonic_lattice
from tests.builders import Oscillators, hand_made

FREQUENCIES = (1.0, 1.37)
GROWTHS = (0.05, 0.02)
Coupling = tuple[float, float]


def coupled_circles(coupling: Coupling, linear: tuple[float, float] = (1.0, 1.0)) -> ReducedModel:
    """Return q_i'' + w_i^2 q_i = mu_i (l_i U - l_i + 1 - E_i - c_i E_j) q_i', E_i = U q_i^2 + q_i'^2 / (U w_i^2).

    At U = 1 the torus q_i = r_i cos(w_i t + phase) is exact, with r_i^2 + c_i r_j^2 = 1.
    """
    terms: dict[tuple[int, tuple[int, ...]], float] = {}
    for i, growth in enumerate(GROWTHS):
        terms[i, (2 + i,)] = linear[i] * growth
        for j, strength in ((i, 1.0), (1 - i, coupling[i])):
            for factor, weight in ((j, 1.0), (2 + j, FREQUENCIES[j] ** -2)):
                terms[i, tuple(sorted((factor, factor, 2 + i)))] = -growth * strength * weight
    damping = np.diag([growth * (slope - 1.0) for growth, slope in zip(GROWTHS, linear, strict=True)])
    return hand_made(Oscillators(np.eye(2), damping, np.diag(np.square(FREQUENCIES)), terms))


def circle_radii(coupling: Coupling) -> tuple[float, float]:
    """Return r_1 and r_2 of the exact torus at U = 1."""
    first, second = np.sqrt(np.linalg.solve([[1.0, coupling[0]], [coupling[1], 1.0]], [1.0, 1.0]))
    return float(first), float(second)


def two_lines(radii: tuple[float, float], frequencies: tuple[float, float], order: Order) -> Tori:
    """Return q_1 = r_1 cos theta_1, q_2 = r_2 cos(theta_1 + theta_2) with w and w + W as frequencies, at U = 1."""
    pairs = harmonic_lattice(order).pairs.tolist()
    coefficients = np.zeros((1, 2, 2 * len(pairs) - 1))
    for i, pair in enumerate(([1, 0], [1, 1])):
        coefficients[0, i, 2 * pairs.index(pair) - 1] = radii[i]
    return Tori(coefficients, np.array([[frequencies[0], frequencies[1] - frequencies[0]]]), np.ones(1), order)
