"""Cycles of one number of loops among others: the joint model, its verdicts, and the finite element model's."""

from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from engine.mechanics.modes import directional_shapes
from engine.models.aerodynamic_load import force
from engine.models.hybrid import hybrid_model, joint_model
from engine.outcome import Stability
from engine.result import Result
from engine.spec import Analysis, LongitudinalInertia, LoopCompetition, Model
from tests.builders import discretized, only, random_line, run, source_line, stable_cycles


@lru_cache
def source_result(subconductors: int) -> Result:
    """Return both models' cycles at 4 m/s, held against one another."""
    return run(source_line(subconductors), Analysis(wind_speeds=(4.0,), loop_competition=LoopCompetition.CHECKED))


@pytest.mark.parametrize("inertia", LongitudinalInertia)
def test_the_joint_model_of_one_number_of_loops_is_the_hybrid_model(inertia: LongitudinalInertia) -> None:
    generator = np.random.default_rng(5)
    discretization = discretized(random_line(generator), random_line(generator))
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3))
    asked = Analysis(longitudinal_inertia=inertia)
    one, joint = hybrid_model(discretization, shapes, (2,), asked), joint_model(discretization, shapes, (2,), asked)
    for name in ("mass", "damping", "stiffness", "shapes"):
        assert getattr(joint, name) == pytest.approx(getattr(one, name)[:, 0], rel=1e-9, abs=1e-9)
    state = generator.normal(scale=0.1, size=(2, 7, 6))
    single = force(
        replace(one.load, **{n: getattr(one.load, n)[:, 0] for n in ("forms", "table", "slopes", "angle")}), state
    )
    assert force(joint.load, state) == pytest.approx(single, rel=1e-9)


def test_each_loops_keeps_its_own_part_of_the_joint_model() -> None:
    discretization = discretized(source_line(2))
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3))
    apart, joint = (
        hybrid_model(discretization, shapes, (3, 1), Analysis()),
        joint_model(discretization, shapes, (3, 1), Analysis()),
    )
    for column in range(2):
        own = np.ix_([0], [column, 2 + column, 4 + column], [column, 2 + column, 4 + column])
        assert joint.mass[own][0] == pytest.approx(apart.mass[0, column], rel=1e-9, abs=1e-9)
        assert joint.damping[own][0] == pytest.approx(apart.damping[0, column], rel=1e-9, abs=1e-9)
    assert joint.direction.tolist() == [0, 0, 1, 1, 2, 2]


def test_one_loop_of_the_single_conductor_gives_way_to_two() -> None:
    rows = {row.loops: row for row in source_result(1).loop_competitions}
    assert rows[1].stability is Stability.UNSTABLE
    assert rows[1].growing_loops == 2
    assert rows[1].growth_per_cycle is not None
    assert 1.0 < rows[1].growth_per_cycle < 1.01
    assert rows[2].stability is Stability.STABLE
    assert stable_cycles(source_result(1), loops=1, wind_speed=4.0)  # alone it lasts
    assert not stable_cycles(source_result(1), loops=1, wind_speed=4.0, model=Model.FINITE_ELEMENT)


def test_both_cycles_of_the_twin_bundle_survive() -> None:
    rows = source_result(2).loop_competitions
    assert [(row.loops, row.stability) for row in rows] == [(1, Stability.STABLE), (2, Stability.STABLE)]
    for loops in (1, 2):
        assert stable_cycles(source_result(2), loops=loops, wind_speed=4.0, model=Model.FINITE_ELEMENT)


def test_a_symmetric_cycle_of_a_symmetric_span_does_not_feel_two_loops() -> None:
    (alone,) = stable_cycles(source_result(2), loops=1, wind_speed=4.0)
    among = next(row for row in source_result(2).loop_competitions if row.loops == 1)
    assert (among.vertical_m, among.horizontal_m) == pytest.approx((alone.vertical_m, alone.horizontal_m), rel=1e-6)
    assert among.branch == alone.branch


def test_nothing_competes_unless_it_is_asked_for() -> None:
    assert run(source_line(1), only(Model.HYBRID, wind_speeds=(4.0,))).loop_competitions == ()
    checked = only(Model.HYBRID, wind_speeds=(4.0,), loops=(2,), loop_competition=LoopCompetition.CHECKED)
    assert run(source_line(1), checked).loop_competitions == ()


def test_the_order_of_the_loops_does_not_matter() -> None:
    backward = only(Model.HYBRID, wind_speeds=(4.0,), loops=(2, 1), loop_competition=LoopCompetition.CHECKED)
    rows = {row.loops: row for row in run(source_line(1), backward).loop_competitions}
    assert rows.keys() == {row.loops for row in source_result(1).loop_competitions} == {1, 2}
    for row in source_result(1).loop_competitions:
        assert rows[row.loops].growing_loops == row.growing_loops
        assert rows[row.loops].growth_per_cycle == pytest.approx(row.growth_per_cycle, rel=1e-6)
