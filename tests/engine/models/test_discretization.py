import numpy as np
import pytest

from engine.mechanics.modes import directional_shapes
from engine.models.discretization import observation
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import take
from engine.spec import Analysis
from tests.builders import discretized, source_line


@pytest.mark.parametrize("loops", [1, 2, 3, 4])
def test_observation_reads_shapes_at_the_first_crest(loops: int) -> None:
    line = source_line(1)
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3, 4))
    model = take(hybrid_model(discretization, shapes, (loops,), Analysis()), 0)
    seen = observation(discretization, model.shapes, loops)[0]
    assert seen == pytest.approx(np.diag(np.diagonal(seen)), abs=1e-15)
    # W and the single conductor's Theta are sines of unit amplitude; four loops have 2.5 elements a half wave.
    assert np.diagonal(seen)[1:] == pytest.approx([1.0, 1.0], abs=4e-3)
