"""Eigenvalues at rest at every wind speed of every model, against those of one model at one wind speed."""

import numpy as np
import pytest

from engine.cycles.at_rest import eigenvalues_at_rest
from engine.models.critical_wind_speeds import at_wind, state_matrices
from engine.models.reduced_model import take
from tests.builders import hybrid, source_line
from tests.engine.motions import perturbed

WINDS = np.array([[1.0, 4.0, 7.0], [2.0, 3.0, 5.0], [1.5, 6.0, 9.0], [4.0, 5.0, 6.0]])


@pytest.mark.parametrize("winds", [WINDS, WINDS[0]])
def test_each_model_has_those_of_its_own_wind_speeds(winds: np.ndarray) -> None:
    model = perturbed(hybrid(source_line(2), 2))
    found = eigenvalues_at_rest(model, winds)
    assert found.shape == (4, 3, 6)
    for i, own in enumerate(np.broadcast_to(winds, WINDS.shape)):
        for j, speed in enumerate(own):
            matrix = at_wind(state_matrices(take(model, [i])), np.array([speed]))[0]
            expected = np.sort_complex(np.linalg.eigvals(matrix))
            assert np.sort_complex(found[i, j]) == pytest.approx(expected, rel=1e-9)


def test_no_wind_speeds_have_none() -> None:
    assert eigenvalues_at_rest(hybrid(source_line(2), 1), np.zeros(0)).shape == (1, 0, 6)
