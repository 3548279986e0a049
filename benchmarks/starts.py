"""Initial states of several energies, directions and phases for hybrid models, and the motions they settle on."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.models import discretized, first_antinode, hybrid_models
from engine.arrays import FloatArray
from engine.checks.direct_starts import spread_starts
from engine.checks.settled_motion import SettledMotions, integrate_until_settled
from engine.spec import Analysis, Line, Model

LOOPS = (1, 2)
WINDS = (4.0, 6.0, 9.0, 12.0)
SOURCE = Analysis(loops=LOOPS, models=(Model.HYBRID,))
LEVELS = (0.02, 0.1, 0.3, 0.8)  # size of a start [rad]: its torsion, or the turn of the wind by its vertical motion
MIXES = 4  # starts per level: one in each direction and one in all three
LONGEST = 600  # blocks of about fifty periods


@dataclass(frozen=True, slots=True)
class Case:
    """A line (from 1), a number of loops, a wind speed [m/s], and the weights for distances between motions.

    weight: (3,), root of M_ii over the shape where motion is observed, so distances are those of kinetic energy.
    """

    line: int
    loops: int
    wind_speed: float
    weight: FloatArray


@dataclass(frozen=True, slots=True)
class Ends:
    """The motions on which all starts settled, equally many per case in order; sizes are at the observed position."""

    cases: list[Case]
    runs: SettledMotions


def ends(
    lines: Sequence[Line],
    seed: int,
    winds: Sequence[float] = WINDS,
    longest: int = LONGEST,
    analysis: Analysis = SOURCE,
) -> Ends:
    """Integrate the hybrid models of lines from a spread of starts.

    Parameters
    ----------
    lines : sequence of Line
    seed : int
        Of the random generator of the starts.
    winds : sequence of float
        [m/s].
    longest : int
        Number of blocks after which the integration of a start stops.
    analysis : Analysis
        Its physics, and numbers of loops whose models have equally many coordinates.

    Returns
    -------
    Ends
    """
    discretization, loops = discretized(lines), analysis.loops
    model, _ = hybrid_models(discretization, loops, analysis)
    m = model.mass.shape[-1]
    usable = np.flatnonzero(~model.statically_unstable)
    member, wind = np.repeat(usable, len(winds)), np.tile(np.array(winds), usable.size)
    each_loops = [first_antinode(model.shapes[i :: len(loops)], k) for i, k in enumerate(loops)]
    seen = np.stack(each_loops, axis=1).reshape(-1, m, 3)[:, :3]
    seen = np.abs(np.diagonal(seen, axis1=-2, axis2=-1))
    starts = spread_starts(model, member, wind, LEVELS, np.random.default_rng(seed))
    each = starts.shape[1]
    runs = integrate_until_settled(
        model, np.repeat(member, each), np.repeat(wind, each), starts.reshape(-1, 2 * m), longest
    )
    weight = np.sqrt(model.modal_masses)[:, :3] / seen
    places = [(i // len(loops) + 1, loops[i % len(loops)], i) for i in member.tolist()]
    cases = [Case(line, k, u, weight[i]) for (line, k, i), u in zip(places, wind.tolist(), strict=True)]
    scale, shown = np.tile(seen, 2)[np.repeat(member, each)], [0, 1, 2, m, m + 1, m + 2]
    size, before = (numbers[:, shown] * scale for numbers in (runs.size, runs.before))
    return Ends(cases, replace(runs, size=np.where(runs.at_rest[:, None], 0.0, size), before=before))
