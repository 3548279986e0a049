"""The rows of the form as its page shows them: fields by the part of a row that holds them, and what stays JSON."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from app.pages.lines.line_fields import FormField
from app.pages.lines.row_lists import REST, RowList, row_lists
from app.pages.lines.rows import Row, kind_of, rows_in


@dataclass(frozen=True, slots=True)
class ShownPart:
    """The fields of one part of a row; `is_open` where it is needed or something was typed into it."""

    name: str
    fields: Sequence[FormField]
    is_open: bool


@dataclass(frozen=True, slots=True)
class ShownRow:
    """A row: its dotted name, its name in words, its kind, its parts, and its JSON where it may have some."""

    name: str
    label: str
    kind: str
    parts: Sequence[ShownPart]
    rest: str | None


@dataclass(frozen=True, slots=True)
class ShownList:
    """A list with its rows, and the kind that the next row is offered to have."""

    row_list: RowList
    rows: Sequence[ShownRow]
    next_kind: str

    @property
    def is_full(self) -> bool:
        """Tell whether the list can have no more rows."""
        return len(self.rows) >= self.row_list.most


def shown_rows(texts: Mapping[str, str]) -> dict[str, ShownList]:
    """Return the lists of a form by their dotted names."""
    found = {}
    for name, rows in rows_in(texts).items():
        row_list = row_lists()[name]
        shown = [_shown(row_list, number, row) for number, row in enumerate(rows)]
        found[name] = ShownList(row_list, shown, shown[-1].kind if shown else next(iter(row_list.kinds)))
    return found


def _shown(row_list: RowList, number: int, row: Row) -> ShownRow:
    kind = kind_of(row_list, row)
    known = row_list.kinds.get(kind)
    rest = row.get(REST, "")
    return ShownRow(
        name=row_list.row_name(number),
        label=row_list.label(number),
        kind=kind,
        parts=list(_parts(row_list, number, kind, row)),
        rest=rest if rest.strip() or (known is not None and known.has_more) else None,
    )


def _parts(row_list: RowList, number: int, kind: str, row: Row) -> Iterator[ShownPart]:
    fields = row_list.fields(number, kind)
    for part in dict.fromkeys(["", *(field.part for field in fields)]):
        own = [field for field in fields if field.part == part]
        typed = any(text.strip() for name, text in row.items() if name.startswith(f"{part}."))
        needed = part in row_list.kinds[kind].required if kind in row_list.kinds else False
        yield ShownPart(part, own, typed or needed)
