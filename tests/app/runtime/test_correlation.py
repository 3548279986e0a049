import pytest
from opentelemetry.trace import NonRecordingSpan, SpanContext, TraceFlags, use_span

from app.runtime import correlation
from app.runtime.correlation import Ids

PARENT = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"


def test_a_callers_ids_are_kept() -> None:
    ids = correlation.of_request("scada:job/17", PARENT)
    assert ids == Ids("scada:job/17", PARENT)
    assert ids.trace_id == "4bf92f3577b34da6a3ce929d0e0e4736"


@pytest.mark.parametrize("given", [None, "", "two words", "line\nbreak", 'quo"te', "é", "a" * 129])
def test_an_id_that_cannot_be_kept_is_replaced(given: str | None) -> None:
    first, second = correlation.of_request(given, None), correlation.of_request(given, None)
    assert first.request_id and len(first.request_id) == 36
    assert first.request_id != second.request_id


@pytest.mark.parametrize(
    "given",
    [
        None,
        "ff" + PARENT[2:],
        PARENT.upper(),
        PARENT + "-00",
        PARENT.replace("4bf92f3577b34da6a3ce929d0e0e4736", "0" * 32),
        PARENT.replace("00f067aa0ba902b7", "0" * 16),
    ],
)
def test_a_trace_parent_that_is_none_is_dropped(given: str | None) -> None:
    ids = correlation.of_request("a", given)
    assert (ids.trace_parent, ids.trace_id) == (None, None)


def test_ids_hold_within_their_block_only() -> None:
    assert correlation.request_id() is None
    with correlation.bound(Ids("outer", PARENT)):
        with correlation.bound(Ids("inner")):
            assert (correlation.request_id(), correlation.trace_parent()) == ("inner", None)
        assert (correlation.request_id(), correlation.trace_parent()) == ("outer", PARENT)
    assert correlation.current() == Ids()


def test_a_span_of_our_own_stands_before_the_callers() -> None:
    span = NonRecordingSpan(SpanContext(0xA, 0xB, is_remote=False, trace_flags=TraceFlags(1)))
    with correlation.bound(Ids("a", PARENT)), use_span(span):
        assert correlation.trace_parent() == f"00-{'a':0>32}-{'b':0>16}-01"
