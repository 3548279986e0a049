import pytest

from app.reference.text_forms import composed, folded, written_forms

ONE, TWO = "Br\u00e5l\u00f8s", "Bra\u030al\u00f8s"
MIXED = "Vi\u00ea\u0323t"  # as a Vietnamese Windows keyboard writes Vi\u1ec7t


@pytest.mark.parametrize(("given", "kept"), [(ONE, ONE), (TWO, ONE), (MIXED, "Vi\u1ec7t"), ("L204", "L204")])
def test_a_text_is_kept_in_one_form(given: str, kept: str) -> None:
    assert composed(given) == kept


def test_a_search_knows_neither_case_nor_form() -> None:
    assert folded(TWO.upper()) == folded(ONE) == ONE.lower()
    assert folded("STRASSE") == folded("Stra\u00dfe")
    assert folded("a") != folded("\u00e5")


def test_what_earlier_versions_stored_is_found() -> None:
    assert written_forms(ONE) == written_forms(TWO) == {ONE, TWO}
    assert written_forms("L204") == {"L204"}
