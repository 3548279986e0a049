"""Read what a cell of a spreadsheet means: truth, number with point or comma, JSON, or text."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, datetime, time, timedelta

from app.schemas.faults import BadInput, parse_json

# What Excel writes for its truth values: English, German, French, Spanish, Italian, Portuguese, Dutch.
_TRUE = frozenset({"true", "wahr", "vrai", "verdadero", "vero", "verdadeiro", "waar"})
_FALSE = frozenset({"false", "falsch", "faux", "falso", "onwaar"})
_NUMBER = re.compile(r"[+-]?(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
_WITH_COMMA = re.compile(r"[+-]?(?:0|[1-9]\d*)?,\d+(?:[eE][+-]?\d+)?", re.ASCII)
_BY_SIGN = re.compile(r"[+-]?[1-9]\d{0,2}(?:[ '\u2019\u00a0\u202f]\d{3})+(?:[.,]\d*)?", re.ASCII)
_BY_POINTS = re.compile(r"[+-]?[1-9]\d{0,2}(?:(?:\.\d{3})+,\d*|(?:\.\d{3}){2,})", re.ASCII)
_BY_COMMAS = re.compile(r"[+-]?[1-9]\d{0,2}(?:(?:,\d{3})+\.\d*|(?:,\d{3}){2,})", re.ASCII)
_ONE_POINT = re.compile(r"[+-]?[1-9]\d{0,2}\.\d{3}", re.ASCII)
_DATE = re.compile(r"\d{1,4}([-./])\d{1,2}\1\d{1,4}(?:[ T].*)?", re.ASCII)
_MOST_DIGITS = 400
_LARGEST_WHOLE = 2.0**53
_SHOWN = 40


@dataclass(frozen=True, slots=True)
class WrongCell:
    """What stands for a cell whose value would be a guess; the sentence says why and what to write."""

    sentence: str


def has_decimal_comma(cells: Sequence[str]) -> bool:
    """Tell whether any cell of a row is a number with a decimal comma."""
    return any(_WITH_COMMA.fullmatch(cell.strip()) for cell in cells)


def value_of(cell: object, *, comma: bool, others_comma: bool = False) -> object:
    """Return the value of a cell: truth, number, JSON value, or the text as it is.

    Parameters
    ----------
    cell : object
        Text, or what a workbook holds: number, truth or date.
    comma : bool
        Whether `0,5` is a number, which it is only if commas do not separate cells.
    others_comma : bool
        Whether numbers of the same row have decimal commas, so that `30.000` would be thirty thousand there.

    Returns
    -------
    object
        A whole number as int, however it is written (`10.0`); a `WrongCell` if the value would be a guess.
    """
    if not isinstance(cell, str):
        return _of_workbook(cell)
    text = cell.strip()
    if _NUMBER.fullmatch(text) and len(text) < _MOST_DIGITS:
        if others_comma and _ONE_POINT.fullmatch(text):
            return WrongCell(f"{text!r} is a thousand or a part of one, since other cells of the row have commas")
        return _number(text)
    if comma and _WITH_COMMA.fullmatch(text) and len(text) < _MOST_DIGITS:
        return _number(text.replace(",", "."))
    return _wrong(text, comma=comma) or _further(text)


def _of_workbook(cell: object) -> object:
    if isinstance(cell, (date, datetime, time, timedelta)):
        return WrongCell(f"is a date or time, {cell}; format the column as numbers and enter the number again")
    return _whole(cell)


def _wrong(text: str, *, comma: bool) -> WrongCell | None:
    shown = repr(text[:_SHOWN])
    if any(pattern.fullmatch(text) for pattern in (_BY_SIGN, _BY_POINTS, _BY_COMMAS)):
        return WrongCell(f"{shown} separates thousands; write the number without separators, such as 1234.5")
    if not comma and _WITH_COMMA.fullmatch(text):
        return WrongCell(
            f"{shown} has a comma, but commas separate the cells; separate them by semicolons, or write a point"
        )
    if _DATE.fullmatch(text):
        return WrongCell(f"{shown} is a date; format the column as numbers and enter the number again")
    return None


def _further(text: str) -> object:
    truth = text.casefold()
    if truth in _TRUE or truth in _FALSE:
        return truth in _TRUE
    try:
        return parse_json(text.encode())
    except BadInput:
        return text


def _number(text: str) -> object:
    return int(text) if text.lstrip("+-").isdecimal() else _whole(float(text))


def _whole(value: object) -> object:
    """Return a number without a fraction as int, because spreadsheets make no difference between 10 and 10.0."""
    if isinstance(value, float) and math.isfinite(value) and value.is_integer() and abs(value) < _LARGEST_WHOLE:
        return int(value)
    return value
