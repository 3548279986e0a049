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
from engine.models.reduced_model import ReducedModel, of_each_member, take


def energy_starts(model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return starts along every unstable mode at every wind speed, by the balance of energy over one period.

    wind_speeds: of all members, (winds,), or of each, (members, winds) [m/s].
    """
    member, wind, speed = _grid_points(model, wind_speeds)
    guess = energy_balance_cycles(take(model, member), speed)
    return _starts(guess, member, wind, speed, harmonics)


def explicit_starts(published: ReducedModel, model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return the explicit cycles of the published closure as starts, for members that are statically stable.

    published: the models with the load of that closure, three coordinates each; model: the same models as they are,
    whose further coordinates start at rest and whose stretching raises the frequency; wind_speeds: as above.
    """
    member, wind, speed = _grid_points(published, wind_speeds)
    guess = explicit_cycles(take(published, member), speed)
    further = model.mass.shape[-1] - published.mass.shape[-1]
    amplitude = np.pad(guess.amplitude, ((0, 0), (0, further)))
    frequency = stiffened_frequencies(model, member[guess.member], guess.angular_frequency, amplitude)
    guess = replace(
        guess, mean=np.pad(guess.mean, ((0, 0), (0, further))), amplitude=amplitude, angular_frequency=frequency
    )
    return _starts(guess, member, wind, speed, harmonics)


def _grid_points(model: ReducedModel, wind_speeds: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Return member, wind speed index and wind speed of all places of members that are statically stable."""
    usable, winds = np.flatnonzero(~model.statically_unstable), of_each_member(model, wind_speeds)
    wind = np.tile(np.arange(winds.shape[-1]), usable.size)
    return np.repeat(usable, winds.shape[-1]), wind, winds[usable].ravel()


def _starts(
    guess: FirstHarmonic,
    member: IntArray,
    wind: IntArray,
    speed: FloatArray,
    harmonics: int,
) -> Starts:
    """Convert first-harmonic cycles at points of the grid to starts with H harmonics."""
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    orbits = Orbits(first, guess.angular_frequency, speed[guess.member])
    return Starts(member[guess.member], wind[guess.member], resized(orbits, harmonics))
