"""The distance that two phases must keep."""

from dataclasses import replace

import pytest

from engine.report.phases.required_clearances import judged, required_between
from engine.spec import Phase
from tests.builders import source_line


def test_the_larger_requirement_of_two_phases_counts_else_that_of_the_line() -> None:
    phases = Phase("top", 7.0, 0.0), Phase("wire", 14.0, 0.0, 1.2), Phase("low", -7.0, 0.0, 1.4)
    line = replace(source_line(2), phases=phases, required_clearance=2.0)
    assert required_between(line, "this", "top") == 2.0
    assert required_between(line, "this", "wire") == 1.2
    assert required_between(line, "wire", "low") == 1.4
    assert required_between(replace(line, required_clearance=None), "this", "top") is None


def test_margin_and_verdict() -> None:
    kept, broken = judged(2.5, 2.0), judged(1.5, 2.0)
    assert (kept["ok"], broken["ok"]) == (True, False)
    assert [kept["margin_m"], broken["margin_m"]] == pytest.approx([0.5, -0.5])
    assert judged(None, 2.0)["ok"] is None
    assert judged(1.0, None)["ok"] is None
