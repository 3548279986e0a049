"""Starts of limit cycles from the first harmonic, at every requested wind speed. Theory section 7.1."""

from dataclasses import replace

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.cycles.first_harmonic import (
    FirstHarmonic,
    energy_balance_cycles,
    explicit_cycles,
    stiffened_frequencies,
)
from engine.cycles.harmonic_balance import Orbits, resized
from engine.cycles.known_cycles import Starts
from engine.models.reduced_model import ReducedModel, take


def energy_starts(model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return starts along every unstable mode at every wind speed [m/s], by the balance of energy over one period."""
    member, wind = _grid_points(model, wind_speeds)
    guess = energy_balance_cycles(take(model, member), wind_speeds[wind])
    return _starts(guess, member, wind, wind_speeds, harmonics)


def explicit_starts(published: ReducedModel, model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return the explicit cycles of the published closure as starts, for members that are statically stable.

    published: the models with the load of that closure, three coordinates each; model: the same models as they are,
    whose further coordinates start at rest and whose stretching raises the frequency.
    """
    member, wind = _grid_points(published, wind_speeds)
    guess = explicit_cycles(take(published, member), wind_speeds[wind])
    further = model.mass.shape[-1] - published.mass.shape[-1]
    amplitude = np.pad(guess.amplitude, ((0, 0), (0, further)))
    frequency = stiffened_frequencies(model, member[guess.member], guess.angular_frequency, amplitude)
    guess = replace(
        guess, mean=np.pad(guess.mean, ((0, 0), (0, further))), amplitude=amplitude, angular_frequency=frequency
    )
    return _starts(guess, member, wind, wind_speeds, harmonics)


def _grid_points(model: ReducedModel, wind_speeds: FloatArray) -> tuple[IntArray, IntArray]:
    usable = np.flatnonzero(~model.statically_unstable)
    return np.repeat(usable, wind_speeds.size), np.tile(np.arange(wind_speeds.size), usable.size)


def _starts(
    guess: FirstHarmonic,
    member: IntArray,
    wind: IntArray,
    wind_speeds: FloatArray,
    harmonics: int,
) -> Starts:
    """Convert first-harmonic cycles at points of the grid to starts with H harmonics."""
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    orbits = Orbits(first, guess.angular_frequency, wind_speeds[wind[guess.member]])
    return Starts(member[guess.member], wind[guess.member], resized(orbits, harmonics))
