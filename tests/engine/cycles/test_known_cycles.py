import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.cycles.harmonic_balance import Orbits
from engine.cycles.known_cycles import KnownCycles, Starts
from tests.builders import Oscillators, hand_made

MODEL = hand_made(Oscillators(np.diag([1.0, 4.0]), np.eye(2), np.eye(2), {}), copies=2)


def starts(*places: tuple[int, int, float], frequency: float = 1.0, phase: float = 0.0) -> Starts:
    """Return motions (member, wind, amplitude) of two harmonics, begun at a phase."""
    member, wind, amplitude = (np.array(column) for column in zip(*places, strict=True))
    turned: FloatArray = np.array([0.1, np.cos(phase), np.sin(phase), 0.2 * np.cos(2 * phase), 0.2 * np.sin(2 * phase)])
    coefficients = amplitude[:, None, None] * turned * np.array([1.0, -0.5])[:, None]
    return Starts(member, wind, Orbits(coefficients, np.full(member.size, frequency), 4.0 + wind))


def recorded(known: KnownCycles, found: Starts) -> list[int]:
    numbers: list[int] = known.add(found, np.ones(found.member.size, dtype=np.bool_), "hopf_branch").tolist()
    return numbers


def test_a_cycle_is_known_again_at_any_phase_and_apart_at_every_place() -> None:
    known = KnownCycles(MODEL)
    assert recorded(known, starts((0, 0, 1.0), (0, 1, 1.0), (1, 0, 1.0))) == [0, 1, 2]
    assert recorded(known, starts((0, 0, 1.0005), (1, 0, 1.0), phase=0.7)) == [0, 2]
    assert recorded(known, starts((0, 0, 1.002))) == [3]
    assert len(known) == 4
    member, wind = known.locations(np.array([2, 1]))
    assert (member.tolist(), wind.tolist()) == ([1, 0], [0, 1])
    assert known.orbits(np.array([3])).coefficients[0, 0, 1] == pytest.approx(1.002)


def test_solutions_that_are_not_good_are_not_recorded() -> None:
    known = KnownCycles(MODEL)
    found = starts((0, 0, 1.0), (0, 0, 2.0))
    assert known.add(found, np.array([False, True]), "energy_balance").tolist() == [-1, 0]
    assert known.found_by == ("energy_balance",)


def test_of_the_starts_that_lead_to_a_known_cycle_the_nearest_is_left_out() -> None:
    known = KnownCycles(MODEL)
    recorded(known, starts((0, 0, 1.0)))
    new = known.new_starts(starts((0, 0, 1.3), (0, 0, 1.1), (0, 1, 1.0), (1, 0, 1.0)))
    assert new.orbits.coefficients[:, 0, 1] == pytest.approx([1.3, 1.0, 1.0])
    assert (new.member.tolist(), new.wind.tolist()) == ([0, 0, 1], [0, 1, 0])
    elsewhere = starts((0, 0, 1.0), frequency=1.03)
    assert known.new_starts(elsewhere).member.size == 1


def test_families_are_numbered_by_their_hopf_points_and_then_by_the_wind() -> None:
    known = KnownCycles(MODEL)
    recorded(known, starts((0, 2, 1.0), (0, 1, 2.0), (0, 0, 3.0), (0, 1, 4.0), (1, 0, 1.0)))
    late, early = known.add_branches(np.array([0, 0]), np.array([9.0, 3.0])).tolist()
    known.link(np.array([late, early, early]), np.array([0, 1, 3]))
    cycles, branches = known.families()
    assert branches.tolist() == [1, 0]
    assert cycles.tolist() == [1, 0, 2, 0, 0]
    assert known.unfollowed().tolist() == [2, 4]


def test_joined_branches_and_their_cycles_are_one_family() -> None:
    known = KnownCycles(MODEL)
    numbers = np.array(recorded(known, starts((0, 0, 1.0), (0, 0, 3.0), (0, 1, 5.0))))
    branches = known.add_branches(np.array([0, 0, 0]), np.array([2.0, 9.0, 8.0]))
    known.link(branches, numbers)
    assert [part.tolist() for part in known.families()] == [[0, 2, 1], [0, 2, 1]]
    known.join([(0, 1)])
    assert [part.tolist() for part in known.families()] == [[0, 0, 1], [0, 0, 1]]
