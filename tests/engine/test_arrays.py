"""Array operations that several packages share."""

import numpy as np
import pytest

from engine.arrays import placed, times_matrix


def test_values_stand_where_they_are_wanted_in_their_order() -> None:
    assert placed(["a", "b"], [False, True, False, True]) == [None, "a", None, "b"]
    assert placed([], [False]) == [None]


@pytest.mark.parametrize("values", [[], ["a"], ["a", "b", "c"]])
def test_as_many_values_as_places_or_a_refusal(values: list[str]) -> None:
    with pytest.raises(ValueError, match="zip"):
        placed(values, [True, False, True])


@pytest.mark.parametrize("stack", [(), (4,), (2, 3), (0, 3)])
def test_vectors_of_a_stack_are_multiplied_with_one_matrix(stack: tuple[int, ...]) -> None:
    generator = np.random.default_rng(0)
    vectors, matrix = generator.normal(size=(*stack, 5)), generator.normal(size=(5, 7))
    assert times_matrix(vectors, matrix).shape == (*stack, 7)
    assert times_matrix(vectors, matrix) == pytest.approx(np.einsum("...i,ij->...j", vectors, matrix), abs=1e-14)
