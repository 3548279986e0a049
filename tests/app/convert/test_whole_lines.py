"""Whole requests made by Hypothesis, through validation and the engine; `tests/faults/test_lines.py` has many more."""

from hypothesis import HealthCheck, given, settings

from app import convert
from app.convert import PointResult
from engine.outcome import InvalidSpec
from tests.app import whole_lines
from tests.app.whole_lines import Json, assert_answers_every_wind, assert_is_named

a_few = settings(derandomize=True, suppress_health_check=[HealthCheck.too_slow])


def assert_is_answered(request: Json) -> None:
    """See that a request is refused by names of its faults, or has an answer for every wind."""
    if faults := convert.check(request):
        for fault in faults:
            assert_is_named(fault.pointer, fault.code, fault.detail)
        return
    try:
        (point,) = [item for item in convert.run(request) if isinstance(item, PointResult)]
    except InvalidSpec as error:  # a table is at fault where the twist turns it, which is known only when it is solved
        assert request["analysis"]["static_twist"] == "solved"
        assert all("table" in fault.rule for fault in error.faults)
    else:
        assert point.failure is None
        assert_answers_every_wind(request["analysis"], point.tables)


@settings(a_few, max_examples=10)
@given(whole_lines.REQUESTS)
def test_usual_lines_are_answered(request: Json) -> None:
    assert_is_answered(request)


@settings(a_few, max_examples=25)
@given(whole_lines.far_off())
def test_lines_with_numbers_far_off_are_answered_or_named(request: Json) -> None:
    assert_is_answered(request)


@settings(a_few, max_examples=60)
@given(whole_lines.broken())
def test_broken_lines_are_named(request: Json) -> None:
    assert_is_answered(request)
