"""The freedoms of an assembly, its ties and links, on small systems whose motion is known."""

import numpy as np
import pytest

from engine.assemblies.assembly import (
    Assembly,
    Joins,
    assembled,
    by_member,
    free_motions,
    natural_motions,
    side_by_side,
    static_response,
)
from engine.mechanics.finite_elements import FIELDS, Matrices, U


def points(members: int) -> Matrices:
    """Return members of one node each, of mass 1 kg on springs of 1 N/m in every direction."""
    eye = np.broadcast_to(np.eye(FIELDS), (members, FIELDS, FIELDS)).copy()
    none = np.zeros((members, FIELDS), dtype=np.bool_)
    return Matrices(eye, eye, none, np.zeros((members, 0, 0, 3)), np.zeros((members, 0, 0)))


def no_joins(freedoms: int) -> Joins:
    return Joins(np.zeros((0, freedoms)), np.zeros((0, freedoms)), np.zeros(0), np.zeros(0))


def two_points(joins: Joins) -> Assembly:
    return assembled(points(2), np.zeros((2, FIELDS), dtype=np.bool_), [joins])


def between(value: float) -> np.ndarray:
    """Return the row that compares U of both points."""
    row = np.zeros((1, 2 * FIELDS))
    row[0, U], row[0, FIELDS + U] = 1.0, value
    return row


def test_members_without_joins_move_by_themselves() -> None:
    squares, displacement = natural_motions(two_points(no_joins(2 * FIELDS)), (U,))
    assert squares == pytest.approx([1.0, 1.0])
    assert np.count_nonzero(displacement) == 2


def test_a_link_stiffens_and_loads_only_the_motion_that_it_feels() -> None:
    # Two equal points with a spring k = 4 and a mass m = 1 on their difference: 1 in phase, (1 + 2 k)/(1 + 2 m) out.
    link = Joins(np.zeros((0, 2 * FIELDS)), between(-1.0), np.array([4.0]), np.array([1.0]))
    squares, displacement = natural_motions(two_points(link), (U,))
    assert squares == pytest.approx([1.0, 3.0])
    assert displacement[0, U] == pytest.approx(displacement[0, FIELDS + U])
    assert displacement[1, U] == pytest.approx(-displacement[1, FIELDS + U])


def test_a_tie_leaves_one_motion() -> None:
    tie = Joins(between(-2.0), np.zeros((0, 2 * FIELDS)), np.zeros(0), np.zeros(0))
    whole = two_points(tie)
    squares, displacement = natural_motions(whole, (U,))
    assert squares == pytest.approx([1.0])
    assert displacement[0, U] == pytest.approx(2.0 * displacement[0, FIELDS + U])
    # x = 2 y under a force of 5 on x: (4 + 1) y = 10
    force = np.zeros(2 * FIELDS)
    force[U] = 5.0
    assert static_response(whole, force, (U,))[[U, FIELDS + U]] == pytest.approx([4.0, 2.0])


def test_the_free_motions_keep_all_ties_and_lose_no_other() -> None:
    generator = np.random.default_rng(3)
    ties = generator.normal(size=(3, 10))
    ties = np.concatenate([ties, ties[:1] - ties[1:2]])  # the last one follows from others
    moving = np.ones(10, dtype=np.bool_)
    moving[4] = False
    basis = free_motions(ties, moving)
    assert basis.shape == (9, 6)
    assert np.linalg.matrix_rank(basis) == 6
    assert np.abs(ties[:, moving] @ basis).max() < 1e-12


def test_fields_of_members_and_displacements_turn_into_each_other() -> None:
    displacement = np.random.default_rng(4).normal(size=(2, 5, 3 * FIELDS * 7))
    fields = by_member(displacement, 3)
    assert fields.shape == (3, 2, 5, FIELDS, 7)
    assert fields[1, 0, 2, U, 3] == displacement[0, 2, FIELDS * 7 + FIELDS * 3 + U]
    assert (side_by_side(fields) == displacement).all()
