"""Mode shapes of sections for pictures."""

import numpy as np
import pytest

from engine.assemblies.section_mode_shapes import section_mode_shapes
from engine.spec import Analysis
from tests.builders import THREE_SPANS, section_line


def test_shapes_run_over_all_spans_and_both_models_agree() -> None:
    found = section_mode_shapes(section_line(THREE_SPANS, subconductors=2), Analysis(loops=(1, 2)))
    assert found.position[[0, -1]] == pytest.approx([0.0, sum(THREE_SPANS)])
    assert (np.diff(found.position) >= 0.0).all()
    assert found.hybrid.shape == (3, 2, 4, 63)
    for direction in range(3):
        own = found.hybrid[direction, :, direction + 1]
        assert np.abs(own).max(axis=-1) == pytest.approx(np.ones(2))
        assert found.finite_element[direction, :, direction + 1] == pytest.approx(own, abs=0.05)
    # the string between the first two spans swings across the line, and holds vertical motion
    at_string = found.hybrid[:, 0, :, 20]
    assert abs(at_string[1, 2]) > 1e-3
    assert at_string[0, 1] == 0.0
