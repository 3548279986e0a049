"""The spans of a section, and sections that cannot be."""

from dataclasses import replace

import pytest

from engine.assemblies.spans import carried_weights, section_faults, spans_of
from engine.mechanics.static_profile import static_profile
from engine.outcome import InvalidSpec
from engine.spec import GRAVITY, IceSegment, Line, Span, SuspensionString
from tests.builders import FIVE_STRINGS, THREE_SPANS, section_line


def with_spans(line: Line, **changes: object) -> Line:
    """Return the line with its second span changed."""
    assert line.section is not None
    first, second, *others = line.section.spans
    spans = (first, replace(second, **changes), *others)  # type: ignore[arg-type]
    return replace(line, section=replace(line.section, spans=spans))


def test_spans_share_the_tension_of_the_span_of_interest() -> None:
    line = section_line(THREE_SPANS, interest=2)
    line = replace(line, span=Span(300.0, sag=8.0))
    spans = spans_of(line)
    assert [span.span.length for span in spans] == list(THREE_SPANS)
    tensions = static_profile(spans).horizontal_tension
    assert tensions == pytest.approx([tensions[1]] * 3, rel=1e-12)
    assert static_profile(spans).sag[1] == pytest.approx(8.0)
    assert all(span.supports.left.dead_end and span.supports.right.dead_end for span in spans)


def test_other_spans_have_ice_and_wind_in_proportion_unless_they_say_their_own() -> None:
    line = section_line(THREE_SPANS)
    half = IceSegment(0.0, 140.0, eccentricity_y=1e-3)
    line = replace(line, ice=replace(line.ice, segments=(half,)), wind=replace(line.wind, profile=((280.0, 2.0),)))
    line = with_spans(line, ice=replace(line.ice, segments=()), profile=((0.0, 0.5),))
    spans = spans_of(line)
    assert spans[1].ice.segments == ()
    assert spans[1].wind.profile == ((0.0, 0.5),)
    assert spans[2].ice.segments[0].stop == pytest.approx(165.0)
    assert spans[2].wind.profile[0][0] == pytest.approx(330.0)


def test_a_string_carries_half_of_both_spans() -> None:
    line = section_line(THREE_SPANS, subconductors=2)
    spans = spans_of(line)
    profile = static_profile(spans)
    arcs = profile.arc_length
    expected = GRAVITY * 2.379 * 2 * 0.5 * (arcs[:-1] + arcs[1:])
    assert carried_weights(spans, profile) == pytest.approx(expected, rel=1e-9)


def test_a_string_in_a_hollow_is_pulled_up() -> None:
    line = section_line(THREE_SPANS, interest=1)
    line = with_spans(replace(line, span=replace(line.span, level_difference=0.0)), level_difference=150.0)
    (fault,) = (f for f in section_faults(line) if f.field.startswith("section.strings"))
    assert fault.field == "section.strings.0.weight"
    assert "pull the string up" in fault.rule


def test_a_string_longer_than_the_sag_is_refused() -> None:
    line = section_line()
    sag = float(static_profile(spans_of(line)).sag[0])
    assert list(section_faults(line)) == []
    assert line.section is not None
    strings = (*(FIVE_STRINGS,) * 3, SuspensionString(sag + 0.1, 1.0))
    (fault,) = section_faults(replace(line, section=replace(line.section, strings=strings)))
    assert (fault.field, fault.value) == ("section.strings.3.length", sag + 0.1)


def test_spans_of_unequal_weight_are_refused() -> None:
    line = section_line()
    heavy = replace(line.ice, segments=(IceSegment(0.0, 100.0, mass=3.0),))
    (fault,) = section_faults(with_spans(line, ice=heavy))
    assert fault.field == "section.spans.1.ice.segments"
    assert fault.value == pytest.approx(2.379 + 0.621 * 100.0 / 350.0)
    # other coefficients, and other eccentricity, weigh nothing
    assert not list(section_faults(with_spans(line, ice=replace(line.ice, eccentricity_y=1e-3))))


def test_ice_beyond_its_span_is_named_with_the_span() -> None:
    line = section_line()
    far = replace(line.ice, segments=(IceSegment(0.0, 400.0, eccentricity_y=1e-3),))
    with pytest.raises(InvalidSpec) as error:
        spans_of(with_spans(line, ice=far))
    assert [fault.field for fault in error.value.faults] == ["section.spans.1.ice.segments.0.stop"]
    assert [fault.field for fault in section_faults(with_spans(line, ice=far))] == [
        "section.spans.1.ice.segments.0.stop"
    ]


def test_level_differences_move_the_weight_to_the_upper_span() -> None:
    line = section_line(THREE_SPANS)
    level, sloping = (spans_of(each) for each in (line, with_spans(line, level_difference=20.0)))
    moved = carried_weights(sloping, static_profile(sloping)) - carried_weights(level, static_profile(level))
    slope = 30e3 * 20.0 / 300.0
    assert moved == pytest.approx([-slope, slope], rel=0.01)
