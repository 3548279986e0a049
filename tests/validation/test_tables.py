"""Motions by a table of the whole circle, theory section 14: in the limit of small ranges, and from large starts."""

from dataclasses import replace

import numpy as np
import pytest

from engine.checks.settled_motion import integrate_until_settled
from engine.cycles.harmonic_balance import balance, resized
from engine.mechanics.modes import directional_shapes
from engine.models.discretization import discretize, in_wind, with_wind_twist
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import take
from engine.outcome import Outcome
from engine.result import LimitCycleRow
from engine.spec import (
    AerodynamicLoad,
    AerodynamicModel,
    Analysis,
    Line,
    LongitudinalInertia,
    Model,
    Stretching,
)
from tests.builders import ICE_AT_40, run, source_line, stable_cycles
from tests.engine.motions import orbit_of
from tests.engine.synthetic_table import with_table

FULL = Analysis(
    loops=(2,),
    models=(Model.HYBRID,),
    wind_speeds=(6.0,),
    critical_wind_limit=15.0,
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)
TABLE = replace(FULL, aerodynamic_model=AerodynamicModel.TABLE)


def known(line: Line) -> Line:
    """Return a line with the cubics that the table has at angle zero."""
    return replace(line, ice=replace(line.ice, aerodynamics=replace(ICE_AT_40, at_rest=(0.0, 1.0, 0.0))))


def only_cycle(line: Line, asked: Analysis) -> LimitCycleRow:
    (row,) = stable_cycles(run(line, asked), loops=2, wind_speed=6.0)
    return row


def test_two_loops_of_the_twin_have_0_1532_m_by_the_table_and_0_1520_m_by_its_cubics() -> None:
    table = only_cycle(with_table(source_line(2), 0.0), TABLE)
    expanded = only_cycle(known(source_line(2)), FULL)
    whole = only_cycle(known(source_line(2)), replace(FULL, aerodynamic_load=AerodynamicLoad.UNEXPANDED))
    assert table.vertical_m == pytest.approx(0.1532, abs=5e-5)
    assert expanded.vertical_m == pytest.approx(0.1520, rel=1e-3)
    assert whole.vertical_m == pytest.approx(0.1520, rel=1e-3)
    assert table.outcome is Outcome.CONVERGED
    assert table.residual is not None
    assert table.residual < 1e-8


def test_small_motions_are_those_of_the_cubics() -> None:
    """One loop of the twin one and ten per cent above its onset: the difference falls with the square of the motion."""
    onset = 2.346
    differences = []
    for wind_speed in (1.01 * onset, 1.1 * onset):
        sizes = []
        for line, asked in ((with_table(source_line(2), 0.0), TABLE), (known(source_line(2)), FULL)):
            result = run(line, replace(asked, loops=(1,), wind_speeds=(wind_speed,)))
            (row,) = stable_cycles(result, loops=1, wind_speed=wind_speed)
            assert row.vertical_m is not None
            sizes.append(row.vertical_m)
        differences.append(sizes[0] / sizes[1] - 1.0)
    assert abs(differences[0]) < 5e-4
    assert 1e-3 < differences[1] < 4e-3


def test_doubling_the_samples_moves_no_coefficient() -> None:
    analysis = replace(TABLE, stretching=Stretching.NEGLECTED)
    system = discretize((with_table(source_line(2), 0.0),))
    shapes = directional_shapes(system.matrices, system.profile.arc_length, (1, 2))
    model = take(hybrid_model(system, shapes, (2,), analysis), 0)
    start, zero = resized(orbit_of(model, 6.0), 5), np.zeros(1, dtype=np.intp)
    found, how = balance(model, zero, start)
    assert how.converged.all()
    assert model.unexpanded is not None
    finest = replace(model, unexpanded=replace(model.unexpanded, samples=4096))
    again, _ = balance(finest, zero, found)
    assert again.coefficients == pytest.approx(found.coefficients, abs=3e-8)


def test_large_starts_come_back_to_the_motion_of_small_ones() -> None:
    """Starts of 1.5 m and 1.2 rad: the load is bounded, whatever the angle of attack."""
    system = in_wind(with_wind_twist(discretize((with_table(source_line(2), 0.0),)), np.array([6.0])), np.array([0]))
    shapes = directional_shapes(system.matrices, system.profile.arc_length, (1, 2))
    model = take(hybrid_model(system, shapes, (1,), TABLE), 0)
    zero = np.zeros(3, dtype=np.intp)
    start = np.zeros((3, 6))
    start[0, 0], start[1, 2], start[2, :3] = 1.5, 1.2, (0.01, 0.002, 0.001)
    runs = integrate_until_settled(model, zero, np.full(3, 6.0), start, 600, 8)
    assert set(runs.outcome.tolist()) == {Outcome.CONVERGED}
    assert runs.size[0, :2] == pytest.approx(runs.size[2, :2], rel=2e-3)
    assert runs.size[1, :2] == pytest.approx(runs.size[2, :2], rel=2e-3)
