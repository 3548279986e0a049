"""Mode shapes for pictures: normalized, aligned, and alike in both models where the source's models agree."""

import numpy as np
import pytest

from engine.mechanics.finite_elements import U, V, W
from engine.models.mode_shapes import mode_shapes
from engine.spec import Analysis
from tests.builders import source_line

LOOPS = Analysis(loops=(1, 2))


@pytest.mark.parametrize("subconductors", [1, 2])
def test_shapes_are_half_sines_of_the_source_lines(subconductors: int) -> None:
    """W of a uniform span is an exact half sine of s, and so is Theta of a single conductor.

    (2/L) int f^2 ds = 1 makes their amplitude 1. Sub-conductors of a bundle stretch as it rotates over its sag.
    """
    found = mode_shapes(source_line(subconductors), LOOPS)
    s = np.linspace(0.0, 1.0, found.position.size)
    assert found.position[[0, -1]] == pytest.approx([0.0, 125.88], abs=1e-9)
    for j, loops in enumerate((1, 2)):
        for i in (1, 2) if subconductors == 1 else (1,):
            np.testing.assert_allclose(found.hybrid[i, j, i + 1], np.sin(loops * np.pi * s), atol=2e-3)


def test_a_direction_of_the_hybrid_model_moves_alone_but_for_the_longitudinal_part_of_the_vertical_one() -> None:
    hybrid = mode_shapes(source_line(2), LOOPS).hybrid
    moving = np.abs(hybrid).max(axis=(1, 3)) > 0.0
    np.testing.assert_array_equal(moving, [[1, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])


def test_finite_element_modes_are_scaled_and_turned_to_the_hybrid_ones() -> None:
    found = mode_shapes(source_line(2), LOOPS)
    for i in range(3):
        own, target = found.finite_element[i, :, i + 1], found.hybrid[i, :, i + 1]
        assert np.abs(own - target).max() < 0.02
        # The residual of a least-squares scale stands at right angles to what was scaled.
        np.testing.assert_allclose(((own - target) * own).sum(axis=-1), 0.0, atol=1e-9)
    longitudinal = found.finite_element[0, 0, U]
    np.testing.assert_allclose(longitudinal, found.hybrid[0, 0, U], atol=0.02)
    assert np.abs(found.finite_element[0, 0, W]).max() < np.abs(found.finite_element[0, 0, V]).max()
