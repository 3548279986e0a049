"""Starts of several energies, directions and phases for the hybrid models of lines, and where they end."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.models import discretized, hybrid_models
from benchmarks.settling import Runs, settled
from engine.arrays import FloatArray, IntArray
from engine.hybrid import ReducedModel, observation
from engine.spec import Line

LOOPS = (1, 2)
WINDS = (4.0, 6.0, 9.0, 12.0)
LEVELS = (0.02, 0.1, 0.3, 0.8)  # of the largest start: rad of torsion, or of the turn of the wind by vertical motion
MIXES = 4  # starts a level: one a direction and one of all three
HORIZONTAL = 2.0  # times the vertical amplitude: horizontal motion alone does not turn the wind
LONGEST = 150  # blocks of some fifty periods


@dataclass(frozen=True, slots=True)
class Case:
    """A line (counted from 1), a number of loops and a wind speed [m/s], with what it takes to measure motions there.

    weight: (3,), root of M_ii over the shape where motion is observed, so that distances are those of kinetic energy.
    """

    line: int
    loops: int
    wind_speed: float
    weight: FloatArray


def spread(model: ReducedModel, member: IntArray, wind_speed: FloatArray, generator: np.random.Generator) -> FloatArray:
    """Draw starts of several energies, directions and phases: (cases, starts, 2 m), q and q'."""
    mass = np.diagonal(model.mass, axis1=-2, axis2=-1)[member]
    rate = np.sqrt(np.diagonal(model.stiffness, axis1=-2, axis2=-1)[member] / mass)
    form = np.abs(model.load.angle[member]).max(axis=1)
    turn = wind_speed / (rate[:, 0] * form[:, 3])
    largest = np.stack([turn, HORIZONTAL * turn, 1.0 / form[:, 2]], axis=-1)
    shares = np.tile(np.concatenate([np.eye(3), np.zeros((1, 3))]), (len(LEVELS), 1))
    shares = np.tile(shares, (member.size, 1, 1))
    shares[:, MIXES - 1 :: MIXES] = np.sqrt(generator.dirichlet(np.ones(3), (member.size, len(LEVELS))))
    phase = generator.uniform(0.0, 2.0 * np.pi, shares.shape)
    amplitude = np.repeat(LEVELS, MIXES)[:, None] * shares * largest[:, None]
    # No start lies on an axis: what its direction leaves out is there by a thousandth.
    amplitude = np.maximum(amplitude, 1e-3 * np.repeat(LEVELS, MIXES)[:, None] * largest[:, None])
    return np.concatenate([amplitude * np.cos(phase), -rate[:, None] * amplitude * np.sin(phase)], axis=-1)


@dataclass(frozen=True, slots=True)
class Ends:
    """Where the starts of all cases ended, equally many a case, one case after the other; sizes are where observed."""

    cases: list[Case]
    runs: Runs


def ends(lines: Sequence[Line], seed: int, winds: Sequence[float] = WINDS, longest: int = LONGEST) -> Ends:
    """Integrate the hybrid models of lines from a spread of starts.

    Parameters
    ----------
    lines : sequence of Line
    seed : int
        Of the generator of the starts.
    winds : sequence of float
        [m/s].
    longest : int
        Number of blocks after which a start is given up.
    """
    made = discretized(lines)
    model, _ = hybrid_models(made, LOOPS)
    usable = np.flatnonzero(~model.statically_unstable)
    member, wind = np.repeat(usable, len(winds)), np.tile(np.array(winds), usable.size)
    seen = np.stack([observation(made, model.shapes[i::2], k) for i, k in enumerate(LOOPS)], axis=1)
    seen = np.abs(np.diagonal(seen.reshape(-1, 3, 3), axis1=-2, axis2=-1))
    starts = spread(model, member, wind, np.random.default_rng(seed))
    each = starts.shape[1]
    runs = settled(model, np.repeat(member, each), np.repeat(wind, each), starts.reshape(-1, 6), longest)
    weight = np.sqrt(np.diagonal(model.mass, axis1=-2, axis2=-1)) / seen
    cases = [Case(i // 2 + 1, LOOPS[i % 2], u, weight[i]) for i, u in zip(member.tolist(), wind.tolist(), strict=True)]
    scale = np.tile(seen, 2)[np.repeat(member, each)]
    size = np.where(runs.at_rest[:, None], 0.0, runs.size * scale)
    return Ends(cases, replace(runs, size=size, before=runs.before * scale))
