"""Whether a bounded motion exists where no stable one is known, and starts near it. Theory sections 7.5 and 12."""

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.checks.direct_starts import fitted_cycles, integrated_to_limit, spread_starts
from engine.cycles.known_cycles import Starts
from engine.cycles.search import Settled
from engine.models.reduced_model import ReducedModel, of_each_member
from engine.outcome import Outcome

LEVELS = (0.03, 0.3)  # rad of torsion, or of the change of wind direction by vertical motion
ROUNDS = 10  # of integration, each as long as a direct start: weak growth needs many periods
SEED = 0


def bounded_motions(
    model: ReducedModel, wind_speeds: FloatArray, harmonics: int, member: IntArray, wind: IntArray
) -> Settled:
    """Integrate small and large starts at wind speeds where the static state is unstable.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    wind_speeds : (winds,) or (members, winds)
        [m/s].
    harmonics : int
    member, wind : (places,)
        Indices of statically stable members and of their wind speeds.

    Returns
    -------
    Settled
        Starts of cycles, approximate, from the motions that did not diverge, and the places where every start diverged.
    """
    speed = of_each_member(model, wind_speeds)[member, wind]
    state = spread_starts(model, member, speed, LEVELS, np.random.default_rng(SEED), alike=True)
    place = np.repeat(np.arange(member.size), state.shape[1])
    state = state.reshape(place.size, -1)
    diverged, at_rest = _ends(model, member[place], speed[place], state, place)
    moving = np.flatnonzero(~diverged & ~at_rest)
    own = place[moving]
    index, orbits = fitted_cycles(model, member[own], speed[own], state[moving], harmonics)
    everywhere = np.bincount(place[~diverged], minlength=member.size) == 0
    return Settled(Starts(member[own[index]], wind[own[index]], orbits), np.stack([member, wind], axis=-1)[everywhere])


def _ends(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, state: FloatArray, place: IntArray
) -> tuple[BoolArray, BoolArray]:
    """Return which starts (starts, 2 m) diverge, and which come to rest; leave the last states in their place.

    Where some starts of a place diverge, those that still change at the end are integrated for further rounds.
    """
    diverged, at_rest = np.zeros((2, place.size), dtype=np.bool_)
    active = np.arange(place.size)
    for _ in range(ROUNDS):
        if active.size == 0:
            break
        runs = integrated_to_limit(model, member[active], wind_speed[active], state[active])
        state[active] = runs.state
        diverged[active], at_rest[active] = runs.outcome == Outcome.NO_CONVERGENCE, runs.at_rest
        changing = active[np.asarray(runs.outcome == Outcome.LIMIT_REACHED, dtype=np.bool_)]
        active = changing[np.isin(place[changing], place[diverged])]
    return diverged, at_rest
