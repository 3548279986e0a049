from unittest import mock

from app import plots
from app.plots.canvas import fonts
from app.plots.canvas.fonts import BASE, MISSING, families, writable


def test_latin_cyrillic_and_arabic_need_no_other_font() -> None:
    assert families("Drake, \u041b\u0438\u043d\u0438\u044f 110 \u043a\u0412, \u062e\u0637 \u0646\u0642\u0644") == [BASE]


def test_a_font_is_added_only_for_what_the_base_font_lacks() -> None:
    covered = {BASE: frozenset(map(ord, "abc")), "Noto Sans": frozenset(map(ord, "abc")), "Han": frozenset([0x67B6])}
    with (
        mock.patch.object(fonts, "_candidates", lambda: ["Noto Sans", "Han"]),
        mock.patch.object(fonts, "_characters", lambda family: covered[family]),
    ):
        assert families("ab \u67b6") == [BASE, "Han"]
        assert writable("a \u67b6 \u7a7a\u8f93 b", [BASE, "Han"]) == f"a \u67b6 {MISSING} b"


def test_no_font_that_has_a_box_for_everything_is_taken() -> None:
    assert not any("Last" in family for family in fonts._installed())
    assert BASE in fonts._installed()


def test_the_font_files_are_true_type_of_two_weights() -> None:
    found = plots.fonts()
    assert list(found) == ["normal", "bold"]
    assert all(content.startswith(b"\x00\x01\x00\x00") for content in found.values())
    assert found["normal"] != found["bold"]
