"""The stretching of free sections against chains of bars, the linear theory and sub-conductor by sub-conductor."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.bundle_chain import stretched
from engine.arrays import FloatArray
from engine.mechanics.free_sections import differences
from engine.mechanics.interpolation import strain_points
from engine.mechanics.static_twist import TwistedState
from engine.models.discretization import Discretization
from engine.models.free_stretching import has_own_tensions, own_stiffness, shares
from engine.models.stretching import (
    StretchingForce,
    dynamic_tension,
    restoring_force,
    restoring_gradient,
    stretching_of,
    take_stretching,
)
from engine.outcome import Outcome
from engine.spec import Bundle, CrossSection, Line, Support, Supports, Yoke
from tests.builders import discretized, source_line

FREE, RIGID = CrossSection.FREE, CrossSection.RIGID
UNEVEN = Bundle(((0.1, 0.05), (-0.2, 0.3), (0.05, -0.25)))
WAVES = 2
COORDINATES = 3 * WAVES
KINDS = {"held": (FREE, Yoke.HELD, "at ends"), "free": (FREE, Yoke.FREE, "nowhere")}
LARGE = np.array([0.6, 0.2, 0.3, 0.2, 0.3, -0.2])  # V and W [m], Theta [rad], in one and two loops


def bundle_line(subconductors: int, *, kind: str = "held", dead_ends: bool = False, uneven: bool = False) -> Line:
    """Return a line of free sections with equal ends."""
    line = source_line(subconductors)
    section, yoke, _ = KINDS[kind]
    positions = UNEVEN.positions if uneven else line.bundle.positions
    end = Support(dead_end=dead_ends, yoke=yoke)
    return replace(
        line,
        bundle=Bundle(positions, section),
        supports=Supports(left=end, right=end),
        span=replace(line.span, elements=20),
    )


def waves(places: int) -> FloatArray:
    """Return V, W and Theta of each coordinate, one and two sines a direction: (coordinates, 3, places)."""
    sines = np.sin(np.pi * np.outer(np.arange(1, WAVES + 1), np.linspace(0.0, 1.0, places)))
    every = np.einsum("df,kp->dkfp", np.eye(3), sines)
    return np.asarray(every.reshape(COORDINATES, 3, places), dtype=np.float64)


def one(made: Discretization, line: int = 0) -> StretchingForce:
    """Return the stretching of the waves of a line."""
    lines, nodes = len(made.lines), 2 * made.lines[0].span.elements + 1
    nodal = np.broadcast_to(waves(nodes), (lines, 1, COORDINATES, 3, nodes))
    found = take_stretching(stretching_of(made, nodal), (line, 0))
    assert found is not None
    return found


def energy(stretching: StretchingForce, q: FloatArray) -> float:
    """Return P, homogeneous of degree three and four, from its derivative."""
    force = [restoring_force(stretching, scale * q[None])[0] for scale in (1.0, -1.0)]
    even, odd = 0.5 * (force[0] + force[1]), 0.5 * (force[0] - force[1])
    return float(q @ (even / 3.0 + odd / 4.0))


def twisted(line: Line, twist: FloatArray) -> Discretization:
    """Return the discretization of a line whose cross-sections are turned by nodal angles."""
    made = discretized(line)
    state = np.zeros(made.matrices.stiffness.shape[:2])
    state[:, 3::4] = twist
    return replace(made, twist=TwistedState(state, np.array([Outcome.CONVERGED], dtype=np.object_)))


ENDS = pytest.mark.parametrize("dead_ends", [True, False], ids=["dead ends", "springs"])
BUNDLES = pytest.mark.parametrize(("subconductors", "uneven"), [(2, False), (3, False), (3, True)])


@ENDS
@pytest.mark.parametrize("kind", KINDS)
@BUNDLES
def test_energy_and_tensions_are_those_of_a_chain_of_bars(
    subconductors: int, uneven: bool, kind: str, dead_ends: bool
) -> None:
    line = bundle_line(subconductors, kind=kind, dead_ends=dead_ends, uneven=uneven)
    made = discretized(line)
    stretching, stiff, small = one(made), made.profile.end_stiffness[0], 1e-3
    motion = np.tensordot(LARGE, waves(101), axes=1).T
    chains = [stretched(line, (stiff[0], stiff[1]), x * motion, KINDS[kind][2]) for x in (1.0, small, -small)]
    quadratic = 0.5 * (chains[1].energy + chains[2].energy) / small**2
    # Springs leave so little stiffness that the squares of U', of the size of H/EA, show in the energy.
    expected = pytest.approx(chains[0].energy - quadratic, rel=1e-3 if dead_ends else 1e-2)
    assert energy(stretching, LARGE) == expected
    assert dynamic_tension(stretching, LARGE[None])[0] == pytest.approx(chains[0].tension, rel=1.5e-3, abs=1.0)


@ENDS
@BUNDLES
def test_differences_of_tension_about_a_large_static_twist(subconductors: int, uneven: bool, dead_ends: bool) -> None:
    line = bundle_line(subconductors, dead_ends=dead_ends, uneven=uneven)
    twist = 0.6 * np.sin(np.pi * np.linspace(0.0, 1.0, 101))
    made = twisted(line, np.interp(np.linspace(0.0, 1.0, 41), np.linspace(0.0, 1.0, 101), twist))
    tension, stiff = dynamic_tension(one(made), LARGE[None])[0], made.profile.end_stiffness[0]
    motion = np.tensordot(LARGE, waves(101), axes=1).T
    chain = stretched(line, (stiff[0], stiff[1]), motion, "at ends", twist).tension
    assert np.ptp(chain) > 150.0
    assert tension - tension.mean() == pytest.approx(chain - chain.mean(), abs=4e-3 * np.ptp(chain))


def test_a_rigid_section_would_not_have_that_energy() -> None:
    line = bundle_line(2)
    free = energy(one(discretized(line)), LARGE)
    rigid = energy(one(discretized(replace(line, bundle=replace(line.bundle, section=RIGID)))), LARGE)
    assert abs(rigid - free) > 0.05 * abs(free)


@ENDS
@pytest.mark.parametrize("kind", KINDS)
def test_the_linear_part_is_the_stiffness_of_the_linear_theory(kind: str, dead_ends: bool) -> None:
    line = bundle_line(3, kind=kind, dead_ends=dead_ends, uneven=True)
    made = discretized(line)
    at, twist = strain_points((line,), made.profile), waves(41)[2 * WAVES :, 2]  # Theta of its coordinates
    rate = np.stack([twist[:, 2 * e : 2 * e + 3] @ at.slopes[0, e].T for e in range(20)], axis=1)
    position = np.array(line.bundle.positions) - np.mean(line.bundle.positions, axis=0)
    lever = np.einsum(
        "ic,epc->iep", position, np.stack([at.section_slopes[0, ..., 1], -at.section_slopes[0, ..., 0]], -1)
    )
    local = line.conductor.axial_rigidity * np.einsum("iep,aep,bep,ep->ab", lever**2, rate, rate, at.weight[0])
    condensed = local + twist @ differences((line,), made.profile, np.zeros((1, 41))).tangent[0] @ twist.T
    stretching = one(made)
    own = (stretching.linear - stretching.linear.mean(axis=0))[:, 2 * WAVES :]
    effective = (at.weight[0] / at.direction[0, ..., 0] ** 2).sum()
    stiffness = own_stiffness((line,), made.profile.yoke_stiffness, np.array([effective]))[0]
    expected = own.T @ own / stiffness if stiffness > 0.0 else np.zeros((WAVES, WAVES))
    # The condensed field keeps T u'^2: H/EA of the local strains that it takes away.
    assert condensed == pytest.approx(expected, abs=1.5e-3 * np.diag(local).max())
    assert expected[0, 0] > 0.1 * local[0, 0] or stiffness == 0.0


def test_ends_that_nothing_holds_leave_no_tension_of_their_own() -> None:
    line = bundle_line(2, kind="free", dead_ends=True)
    made = discretized(line)
    assert own_stiffness((line,), made.profile.yoke_stiffness, np.array([126.0]))[0] == 0.0
    tension = dynamic_tension(one(made), LARGE[None])[0]
    assert tension[0] == pytest.approx(tension[1], rel=1e-12)
    held = dynamic_tension(one(discretized(bundle_line(2, dead_ends=True))), LARGE[None])[0]
    assert held.mean() == pytest.approx(tension[0], rel=1e-12)
    assert abs(held[0] - held[1]) > 100.0


def test_derivatives_agree_with_finite_differences() -> None:
    stretching = one(discretized(bundle_line(3, uneven=True)))
    step = 1e-4
    shifts = step * np.eye(COORDINATES)
    slopes = [(energy(stretching, LARGE + d) - energy(stretching, LARGE - d)) / (2.0 * step) for d in shifts]
    force = restoring_force(stretching, LARGE[None])[0]
    assert force == pytest.approx(slopes, rel=1e-6, abs=1e-6 * np.abs(slopes).max())
    gradient = restoring_gradient(stretching, LARGE[None])[0]
    around = [restoring_force(stretching, LARGE + sign * shifts) for sign in (1.0, -1.0)]
    assert gradient == pytest.approx(((around[0] - around[1]) / (2.0 * step)).T, abs=1e-6 * np.abs(gradient).max())
    assert gradient == pytest.approx(gradient.T, abs=1e-9 * np.abs(gradient).max())


def mixed() -> Sequence[Line]:
    """Return lines with and without own tensions, of different numbers of sub-conductors."""
    rigid = replace(bundle_line(2), bundle=source_line(2).bundle)
    return rigid, bundle_line(2), bundle_line(3, uneven=True), bundle_line(1), bundle_line(4)


def test_a_stack_is_that_of_its_lines() -> None:
    lines = mixed()
    together = discretized(*lines)
    for i, line in enumerate(lines):
        alone, within = one(discretized(line)), one(together, i)
        assert within.table == pytest.approx(alone.table, rel=1e-10, abs=1e-10 * np.abs(alone.table).max())
        ends = [dynamic_tension(x, LARGE[None]) for x in (alone, within)]
        assert [ends[1].min(), ends[1].max()] == pytest.approx([ends[0].min(), ends[0].max()], rel=1e-10)


def test_only_bundles_of_free_sections_have_own_tensions() -> None:
    assert [has_own_tensions(line) for line in mixed()] == [False, True, True, False, True]


def test_shares_add_up_to_nothing() -> None:
    share = shares(mixed()[1:3])
    assert share.shape == (2, 3, 3)
    assert share.sum(axis=1) == pytest.approx(np.zeros((2, 3)), abs=1e-15)
    square = np.sum(np.square(UNEVEN.positions), axis=1)
    assert share[1, :, 2] == pytest.approx(0.5 * (square - square.mean()))
