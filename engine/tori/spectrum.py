"""Spectral lines, their decay, and amplitudes of quasi-periodic motions. Theory section 7.3."""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.models.reduced_model import ReducedModel
from engine.tori.two_frequency_balance import Tori, fourier_basis, harmonic_lattice, phasors, states

WEAKEST = 1e-4  # amplitude of the second line relative to the first, below which a torus is a cycle
SLOWEST = 1e-5  # ratio of the frequencies, below which there is only one
GRID = 96  # samples over each phase and over one period; the error is 5e-4 of the amplitude
STARTS = (4, 32)  # numbers of phases theta_1 and theta_2 at which the compared periods begin


def line_strengths(model: ReducedModel, member: IntArray, tori: Tori) -> FloatArray:
    """Return sum M_ii |q_i|^2 of every pair of harmonics: (tori, n)."""
    mass = model.modal_masses[member]
    return np.asarray(np.einsum("tm,tmn->tn", mass, np.abs(phasors(tori.coefficients)) ** 2))


def base_lines(strengths: FloatArray, pairs: IntArray) -> IntArray:
    """Return where among the pairs (n, 2) the strongest line stands, and the strongest that spans all with it: (2,).

    A multiple of another line, such as 2 w, is passed over: it spans all lines with none.
    """
    order = 1 + np.argsort(-strengths[1:])
    first = order[np.gcd(*pairs[order].T) == 1][0]
    area = np.abs(pairs[:, 0] * pairs[first, 1] - pairs[:, 1] * pairs[first, 0])
    return np.array([first, order[area[order] == 1][0]])


def base_frequencies(model: ReducedModel, member: IntArray, tori: Tori) -> tuple[FloatArray, FloatArray]:
    """Return the frequencies [rad/s] and the strengths of both base lines: (tori, 2) each."""
    pairs = harmonic_lattice(tori.order).pairs
    strengths = line_strengths(model, member, tori)
    lines = np.array([base_lines(own, pairs) for own in strengths], dtype=np.intp).reshape(-1, 2)
    rates = np.abs(tori.angular_frequency @ pairs.T)
    return np.take_along_axis(rates, lines, axis=-1), np.take_along_axis(strengths, lines, axis=-1)


def is_torus(model: ReducedModel, member: IntArray, tori: Tori) -> BoolArray:
    """Return which solutions move with two frequencies: (tori,)."""
    frequencies, strengths = base_frequencies(model, member, tori)
    slow = SLOWEST * tori.angular_frequency.max(axis=-1)
    distinct = (frequencies > slow[:, None]).all(axis=-1) & (np.abs(tori.angular_frequency) > slow[:, None]).all(
        axis=-1
    )
    return np.asarray((strengths[:, 1] > WEAKEST**2 * strengths[:, 0]) & distinct)


def tail(model: ReducedModel, member: IntArray, tori: Tori) -> FloatArray:
    """Return the share of the highest harmonics of either frequency in the size of each torus: (tori,)."""
    pairs = np.abs(harmonic_lattice(tori.order).pairs)
    last = (pairs == tori.order).any(axis=-1)
    strengths = line_strengths(model, member, tori)[:, 1:]
    return np.asarray(np.sqrt(strengths[:, last[1:]].sum(axis=-1) / strengths.sum(axis=-1)))


def amplitude_range(series: FloatArray, torus: Tori, slow: float) -> tuple[FloatArray, FloatArray]:
    """Return half of the peak-to-peak over all time, and the smallest half of it over one period of a frequency.

    Parameters
    ----------
    series : (outputs, 2 n - 1)
        Coefficients of the observed quantities.
    torus : Tori
        A single torus, which gives order and frequencies.
    slow : float
        The frequency whose periods are compared [rad/s].

    Returns
    -------
    pair of arrays (outputs,)
    """
    pairs = harmonic_lattice(torus.order).pairs
    phase = 2.0 * np.pi * np.arange(GRID) / GRID
    values = fourier_basis(_grid(phase, phase), pairs) @ series.T
    starts = _grid(*(2.0 * np.pi * np.arange(count) / count for count in STARTS))
    elapsed = np.linspace(0.0, 2.0 * np.pi / slow, GRID + 1)[:, None]
    windows = fourier_basis(starts[:, None] + elapsed * torus.angular_frequency[0], pairs) @ series.T
    return 0.5 * np.ptp(values, axis=0), 0.5 * np.ptp(windows, axis=1).min(axis=0)


def mean_square_velocity(tori: Tori) -> FloatArray:
    """Return the mean of q'^2 of each coordinate: (tori, m)."""
    rate = tori.angular_frequency @ harmonic_lattice(tori.order).pairs.T
    return np.asarray(0.5 * (np.abs(rate[:, None] * phasors(tori.coefficients)) ** 2).sum(axis=-1))


def sampled_states(tori: Tori) -> FloatArray:
    """Return q and q'/U of tori on a grid over both phases: (tori, samples, 2 m)."""
    phase = 2.0 * np.pi * np.arange(GRID // 2) / (GRID // 2)
    if not tori.wind_speed.size:
        return np.zeros((0, phase.size**2, 2 * tori.coefficients.shape[1]))
    return states(tori, _grid(phase, phase))


def _grid(first: FloatArray, second: FloatArray) -> FloatArray:
    return np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1).reshape(-1, 2)
