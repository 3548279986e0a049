import pytest

from app.pages.lines.numbers import as_number


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("1.5", 1.5),
        ("1,5", 1.5),
        ("\N{MINUS SIGN}2", -2.0),
        ("1 000", 1000.0),
        ("1,000.5", None),
        ("", None),
        ("x", None),
    ],
)
def test_numbers_are_read_as_people_write_them(text: str, number: float | None) -> None:
    assert as_number(text) == number
