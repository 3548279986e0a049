"""Whole requests made by Hypothesis, through validation and the engine; `tests/faults/test_lines.py` has many more."""

from collections import Counter

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app import convert
from app.convert import PointResult
from engine.outcome import InvalidSpec
from tests.app import whole_lines
from tests.app.lines import faults
from tests.app.whole_lines import Json, assert_answers_every_wind, assert_is_named


def outcomes(requests: st.SearchStrategy[Json], count: int) -> Counter[str]:
    """Try this many requests and count what became of them.

    Hypothesis also draws constants of the modules that are loaded: the requests change with the source, and with the
    tests that ran before. The least numbers below leave room for that.
    """
    told: Counter[str] = Counter()

    @settings(max_examples=count, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
    @given(requests)
    def try_one(request: Json) -> None:
        told[outcome(request)] += 1

    try_one()
    return told


def outcome(request: Json) -> str:
    """See that a request is refused by names of its faults, or has an answer for every wind, and return which."""
    if found := faults(request):
        for fault in found:
            assert_is_named(fault.pointer, fault.code, fault.detail)
        return "refused"
    try:
        (point,) = [item for item in convert.run(request) if isinstance(item, PointResult)]
    except InvalidSpec as error:  # a table is at fault where the twist turns it, which is known only when it is solved
        assert request["analysis"].get("static_twist") != "neglected"
        assert ["table" in fault.rule for fault in error.faults] == [True] * len(error.faults)
        return "refused when solved"
    assert point.failure is None
    assert_answers_every_wind(request["analysis"], point.tables)
    return "answered"


def test_usual_lines_are_answered() -> None:
    told = outcomes(whole_lines.REQUESTS, 20)
    assert told["answered"] >= 6, told


def test_lines_with_numbers_far_off_are_answered_or_named() -> None:
    told = outcomes(whole_lines.far_off(), 25)
    assert told["answered"] >= 2, told
    assert told["refused"] >= 4, told


def test_broken_lines_are_named() -> None:
    told = outcomes(whole_lines.broken(), 60)
    assert told["refused"] >= 30, told
