"""Direct integration of many starts at once: exact against scipy's, and what it says of where motions end."""

import numpy as np
import pytest

from engine.checks.direct_starts import spread_starts
from engine.checks.settled_motion import BLOCK_PERIODS, STEPS, integrate_until_settled, lawson_equations
from engine.checks.time_integration import last_period
from engine.cycles.harmonic_balance import states
from engine.models.reduced_model import take
from engine.outcome import Outcome
from tests.builders import Oscillators, hand_made, hybrid, source_line
from tests.engine.motions import COPIES, MODELS, orbit_of, perturbed


@pytest.mark.parametrize("name", MODELS)
def test_a_block_ends_where_dop853_ends(name: str) -> None:
    model = perturbed(MODELS[name]())
    member, wind = np.arange(COPIES) % 4, np.linspace(2.0, 4.0, COPIES)
    start = spread_starts(model, member, wind, (0.1,), np.random.default_rng(2))[:, -1]
    runs = integrate_until_settled(model, member, wind, start, 1)
    duration = BLOCK_PERIODS * STEPS * lawson_equations(model, member, wind).step
    for i in (0, COPIES - 1):
        alone = take(model, int(member[i]))
        expected = last_period(alone, float(wind[i]), start[i], duration[i : i + 1])[0]
        size = np.abs(start[i, : expected.size])
        assert runs.state[i, : expected.size] == pytest.approx(expected, abs=2e-4 * float(size.max()))


def test_a_cycle_of_one_loop_is_where_a_start_beside_it_settles() -> None:
    model, wind = hybrid(source_line(2)), 6.0
    orbit = orbit_of(model, wind)
    start = states(orbit, np.zeros(1))[:, 0] * [1.0, 1.0, 1.0, wind, wind, wind]
    runs = integrate_until_settled(
        model, np.zeros(2, dtype=np.intp), np.full(2, wind), np.concatenate([start, 1.05 * start]), 100
    )
    assert runs.outcome.tolist() == [Outcome.CONVERGED] * 2
    assert runs.blocks[0] < runs.blocks[1]
    expected = np.sqrt(0.5 * (orbit.coefficients[0, :, 1:] ** 2).sum(axis=-1) + orbit.coefficients[0, :, 0] ** 2)
    assert runs.size[0, :3] == pytest.approx(expected, rel=1e-3)
    # A block may still change the size by 2e-5, and what is left falls by a tenth or more a block.
    assert runs.size[1, :3] == pytest.approx(expected, rel=2e-3)


def test_rest_divergence_and_motions_that_go_on_changing_are_told_apart() -> None:
    damped = Oscillators(np.eye(3), np.diag([0.2, 0.2, 0.2]), np.diag([1.0, 1.5, 2.0]), {})
    growing = Oscillators(np.eye(3), np.diag([-0.02, 0.2, 0.2]), np.diag([1.0, 1.5, 2.0]), {})
    slow = Oscillators(np.eye(3), np.diag([1e-5, 0.2, 0.2]), np.diag([1.0, 1.5, 2.0]), {})
    start = np.array([[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]])
    ends = []
    for system, longest in ((damped, 3), (growing, 10), (slow, 3)):
        runs = integrate_until_settled(hand_made(system), np.zeros(1, dtype=np.intp), np.ones(1), start, longest)
        ends.append((runs.outcome[0], bool(runs.at_rest[0])))
    assert ends == [(Outcome.CONVERGED, True), (Outcome.NO_CONVERGENCE, False), (Outcome.LIMIT_REACHED, False)]
