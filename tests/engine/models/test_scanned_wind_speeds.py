"""Critical wind speeds by a scan against those by the polynomial, and over a static state that follows the wind."""

import numpy as np
import pytest

from engine.arrays import IntArray
from engine.mechanics.modes import DirectionalShapes, directional_shapes
from engine.models.critical_wind_speeds import Crossings, StateMatrices, critical_wind_speeds, state_matrices
from engine.models.discretization import Discretization, discretize, in_wind, with_wind_twist
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import ReducedModel, take
from engine.models.scanned_wind_speeds import crossings_in_wind, scan_of, scanned_crossings
from engine.spec import AerodynamicModel, Analysis, Line
from tests.builders import hybrid, source_line
from tests.engine.synthetic_table import overturning_line, with_table

TABLE = Analysis(aerodynamic_model=AerodynamicModel.TABLE)
LIMIT = 30.0


def one_loop(discretization: Discretization) -> ReducedModel:
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1,))
    return take(hybrid_model(discretization, shapes, (1,), TABLE), (slice(None), 0))


def scanned(*lines: Line) -> Crossings:
    def model_of(states: Discretization, own: DirectionalShapes, lines: IntArray) -> ReducedModel:
        return take(hybrid_model(states, own, (1,), TABLE, whole=False), (lines, 0))

    still = discretize(lines)
    shapes = directional_shapes(still.matrices, still.profile.arc_length, (1,))
    return crossings_in_wind(scan_of(still, LIMIT, shapes), np.arange(len(lines)), model_of)


@pytest.mark.parametrize("subconductors", [1, 2, 3])
def test_a_state_that_does_not_move_has_the_crossings_of_the_polynomial(subconductors: int) -> None:
    model = take(hybrid(source_line(subconductors), 2), [0, 0])
    winds = np.linspace(1.0, LIMIT, 30)
    still = state_matrices(model)
    parts = (np.stack([part] * winds.size) for part in (still.constant, still.linear, still.quadratic))
    found = scanned_crossings(winds, StateMatrices(*parts))
    expected = critical_wind_speeds(model, LIMIT)
    order = np.lexsort((found.wind_speed, found.member))
    assert found.member[order].tolist() == expected.member.tolist()
    # Growth below 1e-12 of the largest eigenvalue counts as none.
    assert found.wind_speed[order] == pytest.approx(expected.wind_speed, rel=3e-8)
    assert found.angular_frequency[order] == pytest.approx(expected.angular_frequency, rel=1e-6)
    for name in ("onset", "oscillation", "coordinate", "unstable_after"):
        assert getattr(found, name)[order].tolist() == getattr(expected, name).tolist()


def test_the_onset_of_a_twisting_line_is_that_of_its_state_there() -> None:
    """At the critical wind speed found by the scan, the model about the static state at that speed is critical, too."""
    line = with_table(source_line(1), -20.0)
    found = scanned(line, with_table(source_line(2), 0.0))
    assert set(found.member.tolist()) == {1} or 0 in found.member
    for member, speed in zip(found.member.tolist(), found.wind_speed.tolist(), strict=True):
        own = (line, with_table(source_line(2), 0.0))[member]
        here = in_wind(with_wind_twist(discretize((own,)), np.array([speed])), np.array([0]))
        frozen = critical_wind_speeds(one_loop(here), LIMIT)
        assert np.abs(frozen.wind_speed / speed - 1.0).min() < 3e-3


def test_a_fold_of_the_static_state_is_a_divergence() -> None:
    found = scanned(overturning_line())
    divergences = np.flatnonzero(~found.oscillation)
    assert divergences.size >= 1
    assert 17.0 < found.wind_speed[divergences[0]] < 21.0
    assert found.angular_frequency[divergences[0]] == 0.0
    assert found.coordinate[divergences[0]] == 2
    assert found.onset[divergences[0]]
