"""Starts of limit cycles from the first harmonic, at every requested wind speed. Theory section 7.1."""

from dataclasses import replace

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray
from engine.cycles.first_harmonic import (
    FirstHarmonic,
    energy_balance_cycles,
    explicit_cycles,
    stiffened_frequencies,
)
from engine.cycles.harmonic_balance import Orbits, resized
from engine.cycles.known_cycles import Starts
from engine.models.reduced_model import ReducedModel, of_each_member, take


def energy_starts(
    model: ReducedModel, wind_speeds: FloatArray, harmonics: int, at_rest: ComplexArray | None = None
) -> Starts:
    """Return starts along every unstable mode at every wind speed, by the balance of energy over one period.

    wind_speeds: of all members, (winds,), or of each, (members, winds) [m/s]; at_rest: (members, winds, 2 m), what
    `eigenvalues_at_rest` returns, where it is known.
    """
    usable, winds = _usable(model, wind_speeds)
    values = None if at_rest is None else at_rest[usable]
    return _starts(energy_balance_cycles(take(model, usable), winds, values), usable, winds, harmonics)


def explicit_starts(published: ReducedModel, model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return the explicit cycles of the published closure as starts, for members that are statically stable.

    published: the models with the load of that closure, three coordinates each; model: the same models as they are,
    whose further coordinates start at rest and whose stretching raises the frequency; wind_speeds: as above.
    """
    usable, winds = _usable(published, wind_speeds)
    guess = explicit_cycles(take(published, usable), winds)
    further = model.mass.shape[-1] - published.mass.shape[-1]
    amplitude = np.pad(guess.amplitude, ((0, 0), (0, further)))
    frequency = stiffened_frequencies(model, usable[guess.member], guess.angular_frequency, amplitude)
    guess = replace(
        guess, mean=np.pad(guess.mean, ((0, 0), (0, further))), amplitude=amplitude, angular_frequency=frequency
    )
    return _starts(guess, usable, winds, harmonics)


def _usable(model: ReducedModel, wind_speeds: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the members that are statically stable, (k,), and their wind speeds (k, winds)."""
    usable = np.flatnonzero(~model.statically_unstable)
    return usable, of_each_member(model, wind_speeds)[usable]


def _starts(guess: FirstHarmonic, usable: IntArray, winds: FloatArray, harmonics: int) -> Starts:
    """Convert first-harmonic cycles of some members to starts with H harmonics."""
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    orbits = Orbits(first, guess.angular_frequency, winds[guess.member, guess.wind])
    return Starts(usable[guess.member], guess.wind, resized(orbits, harmonics))
