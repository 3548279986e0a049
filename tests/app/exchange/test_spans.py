import pytest

from app.exchange.coordinates import Course
from app.exchange.spans import SpanNotes, lines_along
from app.sheets.columns import PlacedLine


def test_notes_name_a_few_places_and_count_the_others() -> None:
    notes = SpanNotes()
    for number in range(8):
        notes.compare(f"feature {number}", 300.0 + 10.0 * number, 300.0)
    notes.others.append("Something else.")
    assert notes.sentences() == [
        "Something else.",
        "A given length differs from that of the coordinates by more than 5 %: feature 2, feature 3, feature 4, "
        "feature 5, feature 6 and 1 more.",
    ]


def test_a_line_without_positions_stays_as_it_is() -> None:
    line = PlacedLine("here", {"span": {"length_m": 300.0}}, sources={"/span/length_m": "there"})
    assert list(lines_along(line, None, None, SpanNotes())) == [line]
    (point,) = lines_along(line, Course(((14.0, 50.0),)), {"type": "Point", "coordinates": [14.0, 50.0]}, SpanNotes())
    assert (point.geometry, point.computed) == ({"type": "Point", "coordinates": [14.0, 50.0]}, ())


def test_spans_keep_what_else_is_known_of_the_line() -> None:
    line = PlacedLine("here", {"ice": {}}, sources={"/span/length_m": "there"})
    spans = list(lines_along(line, Course(((14.0, 50.0), (14.0, 50.003), (14.0, 50.006))), None, SpanNotes()))
    assert [(span.place, span.document, span.sources) for span in spans] == [
        (f"here, span {number}", {"ice": {}}, line.sources) for number in (1, 2)
    ]
    assert spans[1].computed[0].value == pytest.approx(333.687, abs=1e-3)
