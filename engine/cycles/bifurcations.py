"""Bifurcations on branches of limit cycles. Theory sections 7.2 and 7.3.

At a torus point (Neimark-Sacker) a pair of Floquet multipliers crosses the unit circle; at a period doubling one
multiplier passes -1, at a branch point 1; at a fold the branch reverses its direction in the parameter. Each is a zero
of a smooth test function along the branch.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from engine.arrays import BoolArray, ComplexArray, FloatArray, IntArray, ObjectArray, filled
from engine.cycles.branch_set import FINE_SHARE, BranchSet, CycleProblem, orbits_of, points_of
from engine.cycles.branches import ends_at_hopf_points
from engine.cycles.floquet import floquet
from engine.cycles.harmonic_balance import Orbits, resized, select
from engine.cycles.transitions import FACTORS, MARGIN, Kind, Transitions, branch_point_factors, product_of, transitions
from engine.models.critical_wind_speeds import Crossings, crossing_error
from engine.models.reduced_model import ReducedModel
from engine.numerics.branch_zeros import locate_zeros, project_onto_branches
from engine.numerics.continuation import BranchPoints, make_points
from engine.numerics.eigenproblems import solve_symmetric

MORE_HARMONICS = 4  # added for locating a bifurcation to those that the branch was followed with
STEP_FACTOR = 4  # on the number of steps of the Floquet integration
ACCURACY = 1e-8  # relative change of the wind speed in the last step
ON_CIRCLE = 1e-5  # largest distance of the critical multiplier from its theoretical place
SAME = 1e-6  # relative distance below which two points are the same
ORDERS = np.arange(4.0)  # multiples of the base frequency near which the second frequency is searched


@dataclass(frozen=True, slots=True)
class Bifurcations:
    """Bifurcations of a stack of models; every array is (k,).

    member: index of the model; branch: number of the connected family; kind: of Kind; parameter: where on its branch,
    the wind speed [m/s] or a field of the line; angular_frequency, second_frequency [rad/s], the second NaN but at a
    torus point; coordinate: the one that moves most; uncertainty: of the parameter; may_end_stability: False where the
    cycle is unstable on both sides for certain.
    """

    member: IntArray
    branch: IntArray
    kind: ObjectArray
    parameter: FloatArray
    angular_frequency: FloatArray
    second_frequency: FloatArray
    coordinate: IntArray
    uncertainty: FloatArray
    may_end_stability: BoolArray


def bifurcations(
    branch_sets: Sequence[BranchSet], followed: IntArray, model: ReducedModel, crossings: Crossings
) -> Bifurcations:
    """Locate every bifurcation on branches that were followed, and list the Hopf points where they begin or end.

    Parameters
    ----------
    branch_sets : sequence of BranchSet
    followed : (branches,)
        Number of the family of each followed branch, for all branch sets one after another.
    model : ReducedModel
        Leading axis (members,).
    crossings : Crossings
        Of these models; a Hopf point that no followed branch touches is not listed.

    Returns
    -------
    Bifurcations
        Sorted by member, branch and parameter; a point that was passed twice is listed once.
    """
    sizes = [branch_set.problem.member.size for branch_set in branch_sets]
    branch = np.split(followed, np.cumsum(sizes)[:-1]) if branch_sets else []
    others = [part for one in zip(branch_sets, branch, strict=True) for part in bifurcations_on(*one)]
    return distinct([_hopf_points(branch_sets, branch, model, crossings), *others])


def bifurcations_on(branch_set: BranchSet, families: IntArray) -> Iterator[Bifurcations]:
    """Locate the bifurcations on branches that were followed; families: (branches,), the family of each."""
    branch_set, found = transitions(branch_set)
    if found.kind:
        yield _locate_bifurcations(branch_set, families, found)


def _locate_bifurcations(branch_set: BranchSet, families: IntArray, places: Transitions) -> Bifurcations:
    """Locate the zero in each of these places with more harmonics; where that fails, return the middle of the place."""
    # Torsion must count here although it carries little energy: the fold of a resonance is one of torsion alone.
    problem = replace(branch_set.problem, smallest_share=FINE_SHARE)
    kinds = np.array(places.kind, dtype=np.object_)
    ends = branch_set.points.select(np.concatenate([places.left, places.right]))
    finer = _with_more_harmonics(problem, ends)
    left, right = np.arange(2 * kinds.size).reshape(2, -1)

    def test(points: BranchPoints, place: IntArray) -> FloatArray:
        return _test_functions(problem, points, kinds[place])

    zero = locate_zeros(problem, finer.select(left), finer.select(right), test, ACCURACY)
    multipliers, error = _multipliers(problem, zero.points)
    critical, distance = _critical_multipliers(multipliers, kinds)
    # Where the trivial multiplier and the critical one meet, both are in error by the root of the integration's error.
    inside = np.isfinite(zero.uncertainty) & (distance < ON_CIRCLE + MARGIN * error)
    z = np.where(inside[:, None], zero.points.z, _with_zeros(problem, ends.z[left]))
    orbits = problem.orbits(z, zero.points.branch)
    member = problem.member[zero.points.branch]
    # Two real multipliers whose product is 1 do not make a torus point.
    torus = np.flatnonzero(kinds == Kind.TORUS)
    real = (np.abs(critical.imag) < ON_CIRCLE) & inside & (kinds == Kind.TORUS)
    second = np.full(kinds.size, np.nan)
    second[torus] = _second_frequency(problem.model, member[torus], select(orbits, torus), critical[torus])
    value = ends.z[:, -1].reshape(2, -1)
    width = np.abs(value[1] - value[0])
    noise = width * error  # a multiplier changes by an amount of order 1 over a segment
    # If refinement moves the zero outside its segment, take the shift of the segment's ends as its uncertainty.
    moved = np.abs(finer.z[:, -1].reshape(2, -1) - value).max(axis=0)
    moved = np.where(np.isfinite(moved), moved, value[1])
    result = Bifurcations(
        member=member,
        branch=families[zero.points.branch],
        kind=np.where(real, filled(kinds.size, Kind.UNRESOLVED), kinds),
        parameter=np.where(inside, z[:, -1], value.mean(axis=0)),
        angular_frequency=orbits.angular_frequency,
        second_frequency=second,
        coordinate=_dominant(problem.model, member, orbits.coefficients[..., 1:]),
        uncertainty=np.where(inside, zero.uncertainty + noise, width + moved),
        may_end_stability=places.may_end,
    )
    return _select(result, np.flatnonzero(~(real & (places.changed == 0))))


def _with_more_harmonics(problem: CycleProblem, points: BranchPoints) -> BranchPoints:
    """Solve for the same points of branches with more harmonics."""
    z, tangent = (_with_zeros(problem, part) for part in (points.z, points.tangent))
    return project_onto_branches(problem, make_points(problem, points.branch, z, tangent))


def _with_zeros(problem: CycleProblem, z: FloatArray) -> FloatArray:
    """Append harmonics of zero to points; they are those of the branch itself, also where more harmonics fail."""
    orbits = orbits_of(z, problem.model.mass.shape[-1])
    return points_of(resized(orbits, orbits.coefficients.shape[-1] // 2 + MORE_HARMONICS))


def _multipliers(problem: CycleProblem, points: BranchPoints) -> tuple[ComplexArray, FloatArray]:
    known = np.flatnonzero(np.isfinite(points.z).all(axis=-1))
    size = 2 * problem.model.mass.shape[-1] - 1
    values = np.full((points.branch.size, size), np.nan, dtype=np.complex128)
    error = np.full(points.branch.size, np.nan)
    here = (points.z[known], points.branch[known])
    floquet_result = floquet(*problem.models(*here), problem.orbits(*here), STEP_FACTOR)
    values[known], error[known] = floquet_result.multipliers[:, 1:], floquet_result.trivial_error
    return values, error


def _test_functions(problem: CycleProblem, points: BranchPoints, kinds: ObjectArray) -> FloatArray:
    """Return the function of each point's type (k,), which vanishes at it; NaN where that is not known."""
    values = np.where(kinds == Kind.FOLD, points.tangent[:, -1], np.nan)
    judged = np.flatnonzero([kind in FACTORS for kind in kinds])
    multipliers, _ = _multipliers(problem, points.select(judged))
    for kind, factors in FACTORS.items():
        own = kinds[judged] == kind
        values[judged[own]] = product_of(factors(multipliers[own]))
    return values


def _critical_multipliers(multipliers: ComplexArray, kinds: ObjectArray) -> tuple[ComplexArray, FloatArray]:
    """Return critical multipliers and their distances from where they should be (at a fold the nearest to 1, and 0)."""
    critical, distance = np.full(kinds.size, np.nan, dtype=np.complex128), np.zeros(kinds.size)
    for kind in dict.fromkeys(kinds.tolist()):
        own = np.flatnonzero(kinds == kind)
        factors = np.abs(FACTORS.get(kind, branch_point_factors)(multipliers[own]))
        smallest = np.where(np.isnan(factors), np.inf, factors).argmin(axis=-1)
        index = np.triu_indices(multipliers.shape[-1], 1)[0][smallest] if kind is Kind.TORUS else smallest
        critical[own] = multipliers[own, index]
        if kind is not Kind.FOLD:
            distance[own] = factors[np.arange(own.size), smallest]
    return critical, distance


def _second_frequency(model: ReducedModel, member: IntArray, orbits: Orbits, critical: ComplexArray) -> FloatArray:
    """Return the second frequency at torus points: of w (k +- theta / 2 pi) the one nearest to a natural frequency."""
    share = np.angle(critical)[:, None] / (2.0 * np.pi)
    candidates = orbits.angular_frequency[:, None] * np.concatenate([ORDERS + share, ORDERS - share], axis=-1)
    natural = np.sqrt(np.abs(solve_symmetric(model.stiffness[member], model.mass[member])[0]))
    with np.errstate(divide="ignore"):
        gap = np.abs(np.log(np.abs(candidates[:, :, None]) / natural[:, None, :])).min(axis=-1)
    return np.asarray(np.abs(np.take_along_axis(candidates, gap.argmin(axis=-1)[:, None], axis=-1)[:, 0]))


def _dominant(model: ReducedModel, member: IntArray, coefficients: FloatArray) -> IntArray:
    mass = model.modal_masses[member]
    return np.asarray((mass * (coefficients**2).sum(axis=-1)).argmax(axis=-1), dtype=np.intp)


def _hopf_points(
    branch_sets: Sequence[BranchSet], branch: Sequence[IntArray], model: ReducedModel, crossings: Crossings
) -> Bifurcations:
    """Return the Hopf points at which followed branches begin or end."""
    hopf = np.flatnonzero(crossings.oscillation)
    number = np.full(hopf.size, -1, dtype=np.intp)
    for branch_set, families in zip(branch_sets, branch, strict=True):
        same = branch_set.problem.member[:, None] == crossings.member[hopf]
        starts = branch_set.hopf_wind_speed[:, None] == crossings.wind_speed[hopf]
        reached = same & (ends_at_hopf_points(branch_set, crossings, hopf) | starts)
        which, where = np.nonzero(reached)
        number[where] = families[which]
    index = hopf[number >= 0]
    return Bifurcations(
        member=crossings.member[index],
        branch=number[number >= 0],
        kind=filled(index.size, Kind.HOPF),
        parameter=crossings.wind_speed[index],
        angular_frequency=crossings.angular_frequency[index],
        second_frequency=np.full(index.size, np.nan),
        coordinate=crossings.coordinate[index],
        uncertainty=crossing_error(model, crossings, index),
        may_end_stability=np.ones(index.size, dtype=np.bool_),
    )


def _concatenated(parts: list[Bifurcations]) -> Bifurcations:
    return Bifurcations(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Bifurcations)))


def _select(points: Bifurcations, index: IntArray) -> Bifurcations:
    return Bifurcations(*(getattr(points, f.name)[index] for f in fields(Bifurcations)))


def distinct(parts: list[Bifurcations]) -> Bifurcations:
    """Return each point once, as it is located best, sorted by member, branch and parameter."""
    found = _concatenated(parts)
    order = np.lexsort((found.parameter, found.branch, found.member))
    found = _select(found, order)
    kept: dict[tuple[int, Kind], list[int]] = {}
    for i, member in enumerate(found.member.tolist()):
        known = kept.setdefault((member, found.kind[i]), [])
        twin = next((place for place, j in enumerate(known) if _same_point(found, i, j)), None)
        if twin is None:
            known.append(i)
        elif found.uncertainty[i] < found.uncertainty[known[twin]]:
            known[twin] = i
    return _select(found, np.array(sorted(i for known in kept.values() for i in known), dtype=np.intp))


def _same_point(found: Bifurcations, i: int, j: int) -> bool:
    """Return whether two points of the same model and type are the same bifurcation."""
    apart = abs(found.parameter[i] - found.parameter[j])
    near = abs(found.angular_frequency[i] / found.angular_frequency[j] - 1.0) < SAME
    return bool(near and apart <= SAME * found.parameter[i] + found.uncertainty[i] + found.uncertainty[j])
