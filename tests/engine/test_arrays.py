"""Array operations that several packages share."""

import pytest

from engine.arrays import placed


def test_values_stand_where_they_are_wanted_in_their_order() -> None:
    assert placed(["a", "b"], [False, True, False, True]) == [None, "a", None, "b"]
    assert placed([], [False]) == [None]


@pytest.mark.parametrize("values", [[], ["a"], ["a", "b", "c"]])
def test_as_many_values_as_places_or_a_refusal(values: list[str]) -> None:
    with pytest.raises(ValueError, match="zip"):
        placed(values, [True, False, True])
