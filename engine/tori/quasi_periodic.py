"""Search for quasi-periodic motions at the requested wind speeds, with their stability. Theory section 7.3.

Tori bifurcate from cycles at torus points and are followed over the wind speed from there. At a wind speed where no
stable motion is known after that, the unstable cycles are tried as well, modulated by the disturbance that grows on
them.
"""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import ComplexArray, FloatArray, IntArray, ObjectArray
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.branches import guessed_points
from engine.cycles.harmonic_balance import Orbits, select
from engine.cycles.search import Cycles
from engine.cycles.transitions import Kind
from engine.models.critical_wind_speeds import unstable_pairs
from engine.models.reduced_model import ReducedModel, of_each_member, take
from engine.numerics.newton import NewtonOptions
from engine.outcome import Stability
from engine.result import FoundBy
from engine.spec import TorusSearch
from engine.tori.spectrum import base_frequencies, is_torus, line_strengths, tail
from engine.tori.torus_branches import (
    TorusStarts,
    critical_directions,
    follow_tori,
    starting_stable_tori,
    starts_at_torus_points,
    tori_from_cycles,
)
from engine.tori.torus_stability import torus_stability
from engine.tori.two_frequency_balance import (
    Order,
    Tori,
    balance,
    harmonic_lattice,
    linearized,
    resized,
    stacked,
    states,
    tori_of,
)

COARSE: Order = (3, 2)  # largest multiples of w and W with which branches are followed
FINE: Order = (5, 4)  # with which tori are solved at the wind speeds
FINEST: Order = (7, 8)  # where the harmonics do not decay within the fine order
TAIL = 1e-3  # share of the last harmonics above which a finer order is used
SAME = 1e-3  # relative difference below which two tori are the same
REAL = 1e-3  # rad from the real axis, below which a multiplier does not modulate
TRIAL = NewtonOptions(tolerance=1e-3, iterations=12)  # of starts that may lead nowhere
ONE_STEP = NewtonOptions(iterations=1)  # the change with one harmonic more is small
PARTS = ("coefficients", "angular_frequency", "wind_speed")
PERIODS = 50  # of direct integration from a torus
DEPTHS = (0.1, 0.3, 0.6, 1.0)  # of modulation that are tried, over the size of the cycle


@dataclass(frozen=True, slots=True)
class QuasiPeriodicMotions:
    """Quasi-periodic motions of a stack of models.

    member, wind: (tori,), indices of model and wind speed; branch: (tori,), family of the cycles that they bifurcate
    from; stability: (tori,) of Stability; found_by: the search that found each; residual: (tori,), largest residual of
    the equations relative to the largest elastic force; truncation: (tori,), relative change of the size with one more
    harmonic of both frequencies; direct: (tori,), relative change of the largest amplitude in 50 periods of direct
    integration, NaN if that was not asked for or the torus is not stable; missing: (k, 2), member and wind speed index
    where no stable motion is known although a complex pair grows on some cycle.
    """

    member: IntArray
    wind: IntArray
    branch: IntArray
    tori: Tori
    stability: ObjectArray
    found_by: tuple[FoundBy, ...]
    residual: FloatArray
    truncation: FloatArray
    direct: FloatArray
    missing: IntArray

    def select(self, index: IntArray) -> "QuasiPeriodicMotions":
        """Select some of the motions."""
        return QuasiPeriodicMotions(
            self.member[index],
            self.wind[index],
            self.branch[index],
            self.tori.select(index),
            self.stability[index],
            tuple(self.found_by[i] for i in index.tolist()),
            self.residual[index],
            self.truncation[index],
            self.direct[index],
            self.missing,
        )


def quasi_periodic_motions(
    model: ReducedModel, cycles: Cycles, bifurcations: Bifurcations, winds: FloatArray, search: TorusSearch
) -> QuasiPeriodicMotions:
    """Find the quasi-periodic motions at the wind speeds, sorted by member and wind speed.

    A model without torus points or growing pairs costs nothing.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    cycles, bifurcations : those on the branches of the cycles
    winds : (winds,) or (members, winds)
        Of all members or of each, in rising order [m/s].
    search : TorusSearch
        Which torus points are followed: those from which stable tori start and those of models with a wind speed at
        which no stable motion is known, or every one.
    """
    motions, winds = _no_motions(model), of_each_member(model, winds)
    if winds.size and any(kind is Kind.TORUS for kind in bifurcations.kind):
        starts = _torus_starts(model, cycles, bifurcations, winds, search)
        motions = _from_torus_points(model, starts, winds)
    locations = _without_stable_motion(cycles, motions)
    if locations:
        motions = _concatenated([motions, _from_unstable_cycles(model, cycles, locations)])
    missing = sorted(_without_stable_motion(cycles, motions)) if locations else []
    sorted_motions = motions.select(np.lexsort((motions.wind, motions.member)))
    return replace(sorted_motions, missing=np.array(missing, dtype=np.intp).reshape(-1, 2))


def _torus_starts(
    model: ReducedModel, cycles: Cycles, bifurcations: Bifurcations, winds: FloatArray, search: TorusSearch
) -> TorusStarts:
    """Return the torus points from which branches are followed."""
    if search is TorusSearch.EVERY:
        every = np.ones(bifurcations.member.size, dtype=np.bool_)
        return starts_at_torus_points(model, cycles.branch_sets, bifurcations, every, COARSE)
    without_stable = [member for member, _ in _without_stable_motion(cycles, _no_motions(model))]
    needed = np.isin(bifurcations.member, without_stable) | bifurcations.may_end_stability
    starts = starts_at_torus_points(model, cycles.branch_sets, bifurcations, needed, COARSE)
    selected = np.isin(starts.member, without_stable)
    others = np.flatnonzero(~selected)
    selected[others[starting_stable_tori(model, starts.select(others))]] = True
    return starts.select(np.flatnonzero(selected))


def check_by_integration(model: ReducedModel, motions: QuasiPeriodicMotions) -> QuasiPeriodicMotions:
    """Integrate the equations from each stable torus and record the relative change of its largest amplitude."""
    from engine.checks.time_integration import last_period, last_times  # noqa: PLC0415 - import scipy's integrators only when asked for

    direct = np.full(motions.member.size, np.nan)
    for i in np.flatnonzero(motions.stability == Stability.STABLE).tolist():
        torus, alone = motions.tori.select(np.array([i])), take(model, int(motions.member[i]))
        wind, m = float(torus.wind_speed[0]), alone.mass.shape[-1]
        times = last_times(2.0 * np.pi / float(torus.angular_frequency[0, 0]), PERIODS)
        start = states(torus, np.zeros((1, 2)))[0, 0] * np.repeat([1.0, wind], m)
        balanced = np.ptp(states(torus, times[:, None] * torus.angular_frequency[0])[0, :, :m], axis=0)
        reached = np.ptp(last_period(alone, wind, start, times), axis=0)
        main = int((balanced * np.sqrt(alone.modal_masses)).argmax())
        direct[i] = reached[main] / balanced[main] - 1.0
    return replace(motions, direct=direct)


def _from_torus_points(model: ReducedModel, starts: TorusStarts, winds: FloatArray) -> QuasiPeriodicMotions:
    """Follow tori from torus points and solve for them where they cross the wind speeds."""
    branch, wind, z = guessed_points(follow_tori(model, starts, winds), winds[starts.member])
    guess = resized(tori_of(z, model.mass.shape[-1], COARSE), FINE)
    return _balanced_tori(model, (starts.member[branch], wind, starts.family[branch]), guess, "torus_point")


def _from_unstable_cycles(model: ReducedModel, cycles: Cycles, locations: set[tuple[int, int]]) -> QuasiPeriodicMotions:
    """Solve for tori from unstable cycles at some places, modulated to several depths by what grows on them."""
    here = [i for i in _with_growing_pair(cycles) if (int(cycles.member[i]), int(cycles.wind[i])) in locations]
    index = np.array(here, dtype=np.intp)
    models, orbits = take(model, cycles.member[index]), select(cycles.orbits, index)
    start = _modulated_cycles(models, orbits, _leading_multipliers(cycles)[index])
    index = np.tile(index, len(DEPTHS))
    member, wind, branch = cycles.member[index], cycles.wind[index], cycles.branch[index]
    tori, solution = balance(model, member, start, TRIAL)
    good = np.flatnonzero(solution.converged)
    good = good[is_torus(model, member[good], tori.select(good))]
    good = good[_first_of_duplicates(model, member[good], wind[good], tori.select(good))]
    guess = resized(tori.select(good), FINE)
    return _balanced_tori(model, (member[good], wind[good], branch[good]), guess, "unstable_cycle")


def _modulated_cycles(model: ReducedModel, orbits: Orbits, multiplier: ComplexArray) -> Tori:
    """Return guesses of tori from cycles and their growing multipliers, one for each depth of modulation.

    The model has the leading axis (cycles,).
    """
    beat = orbits.angular_frequency * np.abs(np.angle(multiplier)) / (2.0 * np.pi)
    start = tori_from_cycles(orbits, beat, COARSE)
    direction = critical_directions(model, start)[:, :-3].reshape(start.coefficients.shape)
    size = np.sqrt(np.einsum("cms,cm->c", orbits.coefficients[..., 1:] ** 2, model.modal_masses))[:, None, None]
    return stacked([replace(start, coefficients=start.coefficients + depth * size * direction) for depth in DEPTHS])


def _balanced_tori(
    model: ReducedModel, locations: tuple[IntArray, IntArray, IntArray], guess: Tori, found_by: FoundBy
) -> QuasiPeriodicMotions:
    """Solve the balance from guesses at members, winds and branches; return the distinct tori with their stability."""
    member, wind, branch = locations
    tori, solution = balance(model, member, guess)
    good = np.flatnonzero(solution.converged)
    good = good[is_torus(model, member[good], tori.select(good))]
    coarse = good[tail(model, member[good], tori.select(good)) > TAIL]
    order = FINEST if coarse.size else guess.order
    tori = resized(tori, order)
    if coarse.size:
        finer, again = balance(model, member[coarse], tori.select(coarse))
        for name in PARTS:
            getattr(tori, name)[coarse] = getattr(finer, name)
        resolved = again.converged & (tail(model, member[coarse], finer) < TAIL)
        good = good[~np.isin(good, coarse[~resolved])]
    good = good[_first_of_duplicates(model, member[good], wind[good], tori.select(good))]
    stability = [torus_stability(take(model, member[[i]]), tori.select(np.array([i]))).stability for i in good]
    return QuasiPeriodicMotions(
        member[good],
        wind[good],
        branch[good],
        tori.select(good),
        np.array(stability, dtype=np.object_),
        (found_by,) * good.size,
        *_residual_and_truncation(model, member[good], tori.select(good)),
        np.full(good.size, np.nan),
        np.zeros((0, 2), dtype=np.intp),
    )


def _residual_and_truncation(model: ReducedModel, member: IntArray, tori: Tori) -> tuple[FloatArray, FloatArray]:
    """Return residual and truncation of tori: (tori,) each."""
    elastic = np.abs(model.stiffness[member] @ tori.coefficients).max(axis=(1, 2), initial=0.0)
    residual = np.abs(linearized(take(model, member), tori)[0]).max(axis=-1, initial=0.0)
    longer, _ = balance(model, member, resized(tori, (tori.order[0] + 1, tori.order[1] + 1)), ONE_STEP)
    before, after = (line_strengths(model, member, t)[:, 1:].sum(axis=-1) for t in (tori, longer))
    return residual / elastic, np.abs(np.sqrt(after / before) - 1.0)


def _without_stable_motion(cycles: Cycles, motions: QuasiPeriodicMotions) -> set[tuple[int, int]]:
    """Return member and wind where no stable motion is known and a pair of multipliers grows on some cycle."""
    locations = set(zip(cycles.member.tolist(), cycles.wind.tolist(), strict=True))
    for found_motions in (cycles, motions):
        judged = found_motions.floquet if isinstance(found_motions, Cycles) else found_motions
        stable = judged.stability == Stability.STABLE
        locations -= set(zip(found_motions.member[stable].tolist(), found_motions.wind[stable].tolist(), strict=True))
    growing = _with_growing_pair(cycles)
    locations &= set(zip(cycles.member[growing].tolist(), cycles.wind[growing].tolist(), strict=True))
    if not locations:
        return locations
    member, wind = np.array(sorted(locations), dtype=np.intp).T
    unstable = unstable_pairs(cycles.at_rest[member, wind]) > 0
    return {place for place, moves in zip(sorted(locations), unstable.tolist(), strict=True) if moves}


def _leading_multipliers(cycles: Cycles) -> ComplexArray:
    """Return the multiplier of largest modulus of each cycle, the trivial one excepted: (cycles,)."""
    others = cycles.floquet.multipliers[:, 1:]
    largest = np.abs(np.nan_to_num(others)).argmax(axis=-1)
    return np.asarray(others[np.arange(len(others)), largest])


def _with_growing_pair(cycles: Cycles) -> IntArray:
    """Return the indices of the unstable cycles on which a complex pair grows fastest."""
    if cycles.member.size == 0:
        return np.zeros(0, dtype=np.intp)
    unstable = np.asarray(cycles.floquet.stability == Stability.UNSTABLE)
    return np.flatnonzero(unstable & (np.abs(np.angle(_leading_multipliers(cycles)) % np.pi) > REAL))


def _first_of_duplicates(model: ReducedModel, member: IntArray, wind: IntArray, tori: Tori) -> IntArray:
    """Return the indices of the distinct solutions, the first of those whose base lines agree at one place."""
    base_lines = np.concatenate(base_frequencies(model, member, tori), axis=-1)
    kept: list[int] = []
    for i, place in enumerate(zip(member.tolist(), wind.tolist(), strict=True)):
        same = [j for j in kept if (member[j], wind[j]) == place]
        if not any(np.allclose(base_lines[i], base_lines[j], rtol=SAME) for j in same):
            kept.append(i)
    return np.array(kept, dtype=np.intp)


def _concatenated(parts: list[QuasiPeriodicMotions]) -> QuasiPeriodicMotions:
    """Concatenate the motions of several searches, with the larger order."""
    padded = [resized(part.tori, max(one.tori.order for one in parts)) for part in parts]
    names = ("member", "wind", "branch", "stability", "residual", "truncation", "direct")
    arrays = {name: np.concatenate([getattr(p, name) for p in parts]) for name in names}
    return QuasiPeriodicMotions(
        tori=stacked(padded),
        found_by=tuple(name for p in parts for name in p.found_by),
        missing=parts[0].missing,
        **arrays,
    )


def _no_motions(model: ReducedModel) -> QuasiPeriodicMotions:
    none, empty, m = np.zeros(0, dtype=np.intp), np.zeros(0), model.mass.shape[-1]
    tori = Tori(np.zeros((0, m, 2 * len(harmonic_lattice(FINE).pairs) - 1)), np.zeros((0, 2)), np.zeros(0), FINE)
    return QuasiPeriodicMotions(
        none, none, none, tori, np.zeros(0, dtype=np.object_), (), empty, empty, empty, np.zeros((0, 2), dtype=np.intp)
    )
