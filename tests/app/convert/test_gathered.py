"""Faults that are collected while a line is built part by part."""

from app.convert.gathered import Gathered
from engine.outcome import Fault, InvalidSpec


def wrong(_: object = None) -> int:
    raise InvalidSpec(Fault("length", -1, "must be positive"), Fault("span.sag", 0, "must be positive"))


def test_a_wrong_part_is_replaced_and_its_faults_are_rooted_once() -> None:
    gathered = Gathered()
    assert gathered.make("span", 3, wrong, 7) == 7
    assert [fault.field for fault in gathered.faults] == ["span.length", "span.sag"]
    assert gathered.neutral == ["span"]


def test_neutral_parts_cause_no_faults() -> None:
    gathered = Gathered()
    assert gathered.settle("span", None, 7) == 7
    assert gathered.attempt("", wrong) is None
    assert [fault.field for fault in gathered.faults] == ["length"]
