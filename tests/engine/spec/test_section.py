"""The rules of a section by itself, and those that it shares with its line."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from engine.outcome import InvalidSpec
from engine.spec import BlowOut, Line, Section, SectionSpan, Support, Supports, SuspensionString
from tests.builders import THREE_SPANS, section_line

LINE = section_line(THREE_SPANS, interest=2)
SPANS, STRINGS = tuple(SectionSpan(x) for x in THREE_SPANS), (SuspensionString(2.4, 600.0),) * 2


def with_section(spans: tuple[SectionSpan, ...] = SPANS, interest: int = 2) -> Callable[[], Line]:
    return lambda: replace(LINE, section=Section(spans, STRINGS, interest))


def second(**changes: object) -> tuple[SectionSpan, ...]:
    return SPANS[0], replace(SPANS[1], **changes), SPANS[2]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("make", "field", "word"),
    [
        (lambda: SectionSpan(0.0), "length", "greater than zero"),
        (lambda: SectionSpan(math.nan), "length", "finite"),
        (lambda: SectionSpan(300.0, level_difference=-301.0), "level_difference", "must not exceed"),
        (lambda: SuspensionString(-1.0, 600.0), "length", "greater than zero"),
        (lambda: SuspensionString(2.4, math.inf), "weight", "finite"),
        (lambda: Section(SPANS, STRINGS[:1]), "section.strings", "which is 2 for 3 spans"),
        (lambda: Section(SPANS, STRINGS * 2), "section.strings", "one string fewer"),
        (lambda: Section(SPANS[:1], ()), "section.spans", "at least 2"),
        (lambda: Section(SPANS, STRINGS, 0), "section.span_of_interest", "from 1 to 3"),
        (lambda: Section(SPANS, STRINGS, 4), "section.span_of_interest", "from 1 to 3"),
        (with_section(interest=1), "section.spans.0.length", "that of the line's span"),
        (with_section(second(level_difference=1.0)), "section.spans.1.level_difference", "that of the line's span"),
        (with_section(second(ice=LINE.ice)), "section.spans.1.ice", "the line describes it"),
        (with_section(second(profile=())), "section.spans.1.profile", "the line describes it"),
        (lambda: replace(LINE, supports=Supports(1e5)), "supports", "section.strings"),
        (lambda: replace(LINE, supports=Supports(left=Support(insulator_length=2.0))), "supports", "dead ends"),
        (lambda: replace(LINE, wind=replace(LINE.wind, blow_out=BlowOut(10.0, 1.0))), "wind.blow_out", "still air"),
    ],
)
def test_a_section_that_breaks_a_rule_names_it(make: Callable[[], object], field: str, word: str) -> None:
    with pytest.raises(InvalidSpec) as caught:
        make()
    (fault,) = caught.value.faults
    assert fault.field == field
    assert word in fault.rule


def test_dead_ends_may_be_said() -> None:
    end = Support(dead_end=True)
    assert replace(LINE, supports=Supports(left=end, right=end)).section == LINE.section
