"""Rows of the form: found among the texts of the form, and added, copied, removed or filled in them."""

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

from app.pages.lines.line_fields import FormField, form_fields, key_of
from app.pages.lines.numbers import as_number
from app.pages.lines.pasted_cells import pasted_cells
from app.pages.lines.row_lists import KIND, REST, RowList, row_lists
from app.pages.wording import words

Row = dict[str, str]
"""The texts of a row by the names of its fields from the row on."""

WINDS = "analysis.wind_speeds_m_per_s"
STEP = "fill.step"
"""The field of the form that says the step of a list of wind speeds; a request has none."""

PASTE = "paste"
"""The first part of the names of the fields that take rows from a sheet; a request has none."""

_RANGE = tuple(f"{WINDS}.{name}" for name in ("start", "stop", "count"))
_SHOWN_DIGITS = 7
_BARELY = 1e-9


@dataclass(frozen=True, slots=True)
class Changed:
    """The texts of a form after a change of its rows: the list, what is said of it, and which id has the focus.

    refused: whether nothing was changed, for the reason that is said.
    """

    texts: dict[str, str]
    row_list: RowList
    said: str
    focus: str
    refused: bool = False


def rows_in(texts: Mapping[str, str]) -> dict[str, list[Row]]:
    """Return the rows of every list, in their order; a row that no list knows is none.

    Of more rows than a list may have, the first too many stands for all others: the schema refuses the list for it.
    """
    found: dict[str, dict[int, Row]] = {name: {} for name in row_lists()}
    for name, text in texts.items():
        match = _row_name().fullmatch(name)
        if match:
            found[match[1]].setdefault(int(match[2]), {})[match[3] or ""] = text
    most = {name: row_list.most + 1 for name, row_list in row_lists().items()}
    return {name: [rows[number] for number in sorted(rows)[: most[name]]] for name, rows in found.items()}


def numbered(texts: Mapping[str, str]) -> dict[str, str]:
    """Return the texts of a form with the rows of each list numbered from 0."""
    return _with_rows(texts, rows_in(texts))


def kind_of(row_list: RowList, row: Row) -> str:
    """Return the kind of a row, as it was said."""
    return row.get(KIND, "") if row_list.has_kinds else ""


def is_blank(row: Row) -> bool:
    """Tell whether nothing was typed into a row but its kind."""
    return not any(text.strip() for name, text in row.items() if name != KIND)


def fields_in(texts: Mapping[str, str]) -> dict[str, FormField]:
    """Return all fields of a form by their names, with those of its rows."""
    return form_fields() | {field.name: field for field in _row_fields(rows_in(texts))}


def changed(texts: Mapping[str, str], change: str) -> Changed | None:
    """Return the form after a change such as `add line.devices`, `copy line.devices 2`; None for any other text.

    `remove` takes a row away, `kind` shows the fields of another kind, `fill` lists wind speeds one by one, `paste`
    adds rows from the cells of a sheet.
    """
    match = _CHANGE.fullmatch(change)
    row_list = row_lists().get(match[2]) if match else None
    if match is None or row_list is None:
        return None
    if match[1] == "fill":
        return _filled(texts, row_list) if row_list.name == WINDS else None
    if match[1] == "paste":
        return _pasted(texts, row_list) if row_list.columns else None
    number = len(rows_in(texts)[row_list.name]) if match[1] == "add" else int(match[3] or 0)
    return _changed_at(texts, row_list, match[1], number)


def _changed_at(texts: Mapping[str, str], row_list: RowList, change: str, number: int) -> Changed | None:
    rows = rows_in(texts)
    own = rows[row_list.name]
    if number >= len(own) + (change == "add"):
        return None
    if change in {"add", "copy"} and len(own) >= row_list.most_rows:
        return _refused(texts, row_list, words().rows.full, _add_key(row_list))
    if change == "add":
        own.append(_new(row_list, texts.get(f"add.{row_list.name}", "")))
    elif change == "copy":
        number += 1
        own.insert(number, dict(own[number - 1]))
    elif change == "remove":
        del own[number]
    said = getattr(words().rows.changed, change).format(row=row_list.label(number), count=len(own))
    return Changed(_with_rows(texts, rows), row_list, said, _focus(own, row_list, change, number))


def _new(row_list: RowList, kind: str) -> Row:
    if row_list.is_plain:
        return {"": ""}
    return {KIND: kind if kind in row_list.kinds else next(iter(row_list.kinds))} if row_list.has_kinds else {}


_CHANGE = re.compile(r"(add|copy|remove|kind|fill|paste) (\S{1,80})(?: (\d{1,6}))?")


def _focus(rows: Sequence[Row], row_list: RowList, change: str, number: int) -> str:
    """Return the id of the first control of a new row; of the row in the place of one that was removed."""
    if not rows:
        return _add_key(row_list)
    number = min(number, len(rows) - 1)
    if change == "remove" or row_list.is_plain:
        return key_of(row_list.row_name(number))
    first = KIND if row_list.has_kinds else next(iter(row_list.kinds.values())).fields[0].name
    return key_of(row_list.field_name(number, first))


def _refused(texts: Mapping[str, str], row_list: RowList, said: str, focus: str) -> Changed:
    return Changed(
        dict(texts), row_list, said.format(most=row_list.most_rows, columns=len(row_list.columns)), focus, refused=True
    )


def _add_key(row_list: RowList) -> str:
    return f"add-{key_of(row_list.name)}"


def _filled(texts: Mapping[str, str], row_list: RowList) -> Changed:
    """Return the form with its evenly spaced wind speeds as rows; the fields of the range become empty."""
    speeds = list(_speeds([as_number(texts.get(name, "")) for name in (*_RANGE, STEP)], row_list.most_rows))
    if not speeds:
        return _refused(texts, row_list, words().rows.not_filled, key_of(STEP))
    rows = {**rows_in(texts), row_list.name: [{"": f"{speed:.{_SHOWN_DIGITS}g}"} for speed in speeds]}
    left = {name: "" if name in {*_RANGE, STEP} else text for name, text in texts.items()}
    said = words().rows.filled.format(count=len(speeds))
    return Changed(_with_rows(left, rows), row_list, said, key_of(row_list.row_name(0)))


def _pasted(texts: Mapping[str, str], row_list: RowList) -> Changed:
    """Return the form with the rows of a sheet after those into which something was typed."""
    field = f"{PASTE}.{row_list.name}"
    names = [column.name for column in row_list.columns]
    cells = pasted_cells(texts.get(field, ""), len(names))
    rows = rows_in(texts)
    kept = [row for row in rows[row_list.name] if not is_blank(row)]
    if not cells or len(kept) + len(cells) > row_list.most_rows or max(map(len, cells)) > len(names):
        return _refused(texts, row_list, words().rows.not_pasted, key_of(field))
    rows[row_list.name] = kept + [dict(zip(names, line, strict=False)) for line in cells]
    first = key_of(row_list.field_name(len(kept), names[0]))
    said = words().rows.pasted.format(count=len(cells))
    return Changed(_with_rows({**texts, field: ""}, rows), row_list, said, first)


def _speeds(said: Sequence[float | None], most: int) -> Iterator[float]:
    """Yield evenly spaced speeds from a first and a last one with a number or, rather, a step; none if it cannot."""
    start, stop, count, step = said
    if start is None or stop is None or not start < stop:
        return
    if step is None:
        step = (stop - start) / (count - 1.0) if count is not None and count >= 2.0 else 0.0
    if not math.isfinite(step) or step <= 0.0 or (stop - start) / step > most - 1 + _BARELY:
        return
    for number in range(math.floor((stop - start) / step + _BARELY) + 1):
        yield start + number * step


def _with_rows(texts: Mapping[str, str], rows: Mapping[str, Sequence[Row]]) -> dict[str, str]:
    single = {name: text for name, text in texts.items() if not _row_name().fullmatch(name)}
    lists = row_lists()
    return single | {
        lists[name].field_name(number, within): text
        for name, own in rows.items()
        for number, row in enumerate(own)
        for within, text in (row.items() if row else [(REST, "")])
    }


def _row_fields(rows: Mapping[str, Sequence[Row]]) -> Iterator[FormField]:
    for name, own in rows.items():
        row_list = row_lists()[name]
        for number, row in enumerate(own):
            yield from row_list.fields(number, kind_of(row_list, row))


@cache
def _row_name() -> re.Pattern[str]:
    return re.compile(rf"({'|'.join(map(re.escape, row_lists()))})\.(\d{{1,6}})(?:\.(.*))?")
