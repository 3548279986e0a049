"""Arrangements keep separation, supports and taken places, and mirror images stay mirror images."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.spec import DetuningPendulum, Spacer
from engine.studies.arrangements import Room, neighbours, practice, room_on
from tests.builders import source_line

LENGTH = 300.0
ROOM = Room(15.0, 285.0, 15.0)


def mirrored(places: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(LENGTH - place, 2) for place in reversed(places))


def are_images(some: list[tuple[float, ...]], others: list[tuple[float, ...]]) -> bool:
    """Return whether arrangements are the mirror images of others, but for a rounding at the edge of the room."""
    images = [mirrored(places) for places in some]
    matched = [any(one == pytest.approx(other, abs=0.021) for other in others) for one in images]
    return matched.count(False) <= (0 if len(images) == len(others) else abs(len(images) - len(others)))


def test_practice_names_quarter_points_and_mid_span() -> None:
    assert practice(1, ROOM, LENGTH) == [(150.0,), (75.0,), (225.0,)]
    assert (75.0, 225.0) in practice(2, ROOM, LENGTH)
    assert (75.0, 150.0, 225.0) in practice(3, ROOM, LENGTH)
    assert (60.0, 120.0, 180.0, 240.0) in practice(4, ROOM, LENGTH)
    assert (75.0, 142.5, 157.5, 225.0) in practice(4, ROOM, LENGTH)


def test_a_span_without_room_has_no_arrangement() -> None:
    assert practice(20, Room(15.0, 285.0, 15.0), LENGTH) == []
    assert Room(0.0, 10.0, 6.0).fitted([5.0, 5.0, 5.0]) is None


def test_places_are_pushed_apart_evenly_to_both_sides() -> None:
    assert ROOM.fitted([150.0, 150.0]) == (142.5, 157.5)
    assert ROOM.fitted([0.0, 0.0]) == (15.0, 30.0)


def test_devices_of_the_line_take_room_but_spacers_do_not() -> None:
    line = source_line(2)
    fitted = room_on(replace(line, devices=(DetuningPendulum(62.94, 10.0, 0.3), Spacer(30.0, 6.5, 0.4))), 6.0)
    assert fitted.taken == (62.94,)
    assert fitted.lowest == 6.0
    assert fitted.highest == pytest.approx(119.88)
    (first, *_) = practice(1, fitted, line.span.length)
    assert abs(first[0] - 62.94) >= 6.0 - 1e-6


@given(
    st.integers(1, 8),
    st.floats(0.0, 20.0),
    st.lists(st.floats(0.0, LENGTH), max_size=3),
    st.sampled_from([15.0, 7.5, 3.75]),
)
def test_all_arrangements_keep_the_rules_and_come_with_their_mirror_images(
    count: int, separation: float, taken: list[float], step: float
) -> None:
    room = Room(separation, LENGTH - separation, separation, tuple(taken))
    image = Room(separation, LENGTH - separation, separation, tuple(LENGTH - place for place in taken))
    found = practice(count, room, LENGTH)
    assert all(len(places) == count and room.holds(places) for places in found)
    if not taken:
        assert are_images(found, practice(count, image, LENGTH))
    for places in found[:2]:
        around = neighbours(places, room, step, LENGTH)
        assert all(room.holds(one) and one != places for one in around)
        if not taken:
            assert are_images(around, neighbours(mirrored(places), image, step, LENGTH))
