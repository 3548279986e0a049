import pytest

from app.plots.canvas.wrapping import shortened, width_of, wrapped


def test_a_text_is_as_wide_as_in_the_base_font() -> None:
    assert width_of("m") == pytest.approx(0.974, abs=1e-3)
    assert width_of("\u67b6\u7a7a") == 2.0
    assert width_of("e\u0301") == width_of("e")


def test_lines_break_at_spaces_between_wide_characters_and_in_long_words() -> None:
    assert wrapped("one two three", 5.0, 5) == ["one two", "three"]
    assert wrapped("\u67b6\u7a7a\u8f93\u7535\u7ebf\u8def", 3.0, 5) == ["\u67b6\u7a7a\u8f93", "\u7535\u7ebf\u8def"]
    assert "".join(wrapped("x" * 40, 6.0, 9)) == "x" * 40
    assert max(map(width_of, wrapped("x" * 40, 6.0, 9))) <= 6.0
    assert wrapped("", 5.0, 2) == [""]


def test_what_does_not_fit_ends_with_an_ellipsis() -> None:
    lines = wrapped("rests " * 50, 10.0, 2)
    assert len(lines) == 2
    assert lines[1].endswith("\u2026")
    assert width_of(lines[1]) <= 10.0
    assert shortened("short", 10.0) == "short"
