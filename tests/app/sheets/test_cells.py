import math
from datetime import date, datetime, time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.sheets.cells import WrongCell, has_decimal_comma, value_of

FINITE = st.floats(allow_nan=False, allow_infinity=False)


@given(FINITE, st.sampled_from(["{!r}", "{:.6f}", "{:.5e}", "{:E}", "{:+.3f}"]))
def test_a_number_is_the_same_with_point_and_comma(number: float, form: str) -> None:
    text = form.format(number)
    point, comma = value_of(text, comma=False), value_of(text.replace(".", ","), comma=True)
    assert point == comma == float(text)
    assert isinstance(point, int) == (float(text).is_integer() and abs(float(text)) < 2.0**53)


@pytest.mark.parametrize(
    ("cell", "value"),
    [
        ("TRUE", True), ("false", False), (" Wahr ", True), ("FALSCH", False), ("FAUX", False), (True, True),
        ("10.0", 10), ("10,0", 10), ("1E+05", 100_000), (",5", 0.5), (".5", 0.5), ("+3", 3), ("5.", 5), (10.0, 10),
        (2.5, 2.5), ("-0,0286", -0.0286), ("[1, 2.5]", [1, 2.5]), ('{"a": "ft"}', {"a": "ft"}),
        ("007", "007"), ("null", None), ("constant_ratio", "constant_ratio"), ("#N/A", "#N/A"), ("1,234", 1.234),
    ],
)  # fmt: skip
def test_cells_mean_what_the_sheet_shows(cell: object, value: object) -> None:
    found = value_of(cell, comma=True)
    assert found == value and type(found) is type(value)


@pytest.mark.parametrize("cell", ["1,234,567", "1.234.567", "1.234,5", "1,234.5", "30 000", "30'000,5", "1\u00a0234"])
@pytest.mark.parametrize("comma", [True, False])
def test_separators_of_thousands_are_refused(cell: str, comma: bool) -> None:
    found = value_of(cell, comma=comma)
    assert isinstance(found, WrongCell) and "separates thousands" in found.sentence and repr(cell) in found.sentence


def test_a_point_beside_commas_may_separate_thousands() -> None:
    assert value_of("30.000", comma=True) == 30
    assert isinstance(value_of("30.000", comma=True, others_comma=True), WrongCell)
    assert value_of("0.125", comma=True, others_comma=True) == 0.125
    assert has_decimal_comma(["x", " 1,5 "]) and not has_decimal_comma(["x", "1.5", "1,2,3", "[1,5]"])


@pytest.mark.parametrize("cell", ["0,5", "1,234"])
def test_a_comma_in_a_cell_between_commas_is_refused(cell: str) -> None:
    found = value_of(cell, comma=False)
    assert isinstance(found, WrongCell) and "semicolons" in found.sentence


@pytest.mark.parametrize(
    "cell", ["2026-05-01", "01.05.2026", "1/5/26 00:00", date(2026, 5, 1), datetime(2026, 5, 1), time(1)]
)
def test_dates_are_refused(cell: object) -> None:
    found = value_of(cell, comma=False)
    assert isinstance(found, WrongCell) and "date" in found.sentence


def test_very_long_digits_stay_what_they_are() -> None:
    assert value_of("9" * 400, comma=False) == int("9" * 400)
    assert value_of("1e999", comma=False) == math.inf
    assert value_of("9" * 5000, comma=False) == "9" * 5000
