"""The local search on scores that are formulas: it finds their minimum, keeps the rules, and may find nothing."""

import math
from collections.abc import Callable, Sequence

import pytest

from engine.progress import finished
from engine.studies.arrangements import Places, Room
from engine.studies.place_search import Found, Score, search

LENGTH = 200.0
ROOM = Room(10.0, 190.0, 10.0)


def found(count: int, score: Callable[[Places], Score], *, rounds: int = 10) -> Found:
    def scores(several: Sequence[Places]) -> list[Score]:
        return [score(places) for places in several]

    return finished(search(count, ROOM, LENGTH, scores, rounds=rounds))


def test_it_comes_near_the_minimum() -> None:
    best = found(2, lambda places: (1.0 + (places[0] - 62.0) ** 2 + (places[1] - 171.0) ** 2, 0.0)).places[0]
    assert best == pytest.approx((62.0, 171.0), abs=5.0)


def test_it_keeps_the_separation_where_the_score_wants_all_at_one_tower() -> None:
    places = found(4, lambda places: (1.0 + sum(places), 0.0)).places[0]
    assert ROOM.holds(places)
    assert places[0] >= 10.0


def test_a_mirrored_score_gives_the_same_value() -> None:
    def score(places: Places) -> Score:
        return 1.0 + sum(math.sin(0.03 * place) for place in places), 0.0

    def image(places: Places) -> Score:
        return score(tuple(LENGTH - place for place in reversed(places)))

    assert score(found(3, score).places[0])[0] == pytest.approx(image(found(3, image).places[0])[0], rel=1e-9)


def test_a_symmetric_score_gets_a_symmetric_answer() -> None:
    places = found(3, lambda places: (1.0 + sum((place - 100.0) ** 2 for place in places), 0.0)).places[0]
    assert places == pytest.approx([LENGTH - place for place in reversed(places)])


def test_the_second_number_decides_where_the_first_is_equal() -> None:
    (best, *_) = found(1, lambda places: (0.0, -places[0])).places
    assert best[0] > 180.0


def test_nothing_acceptable_is_nothing_found() -> None:
    none = found(2, lambda _: (math.inf, math.inf))
    assert none.places == ()
    assert none.arrangements > 2


def test_without_rounds_only_practice_is_computed() -> None:
    assert found(1, lambda places: (places[0], 0.0), rounds=0) == Found(((50.0,), (100.0,), (150.0,)), 3)
