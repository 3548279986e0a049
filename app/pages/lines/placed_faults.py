"""Faults of a request at the places of the form: beside a field, at a row, at a list, or above all."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from app.pages.lines.line_fields import form_fields, key_of
from app.pages.lines.row_lists import KIND, REST, RowList, row_lists
from app.pages.lines.rows import is_blank, rows_in
from app.pages.lines.shown_rows import ShownRow, shown_rows
from app.pages.wording import words
from app.schemas.faults import Fault


@dataclass(frozen=True, slots=True)
class Place:
    """A place of the form where faults stand: its dotted name, its name in words, and whether it is a control."""

    name: str
    label: str
    is_field: bool = True

    @property
    def key(self) -> str:
        """Return the name as an id of HTML."""
        return key_of(self.name)


@dataclass(frozen=True, slots=True)
class PlacedFaults:
    """Every place of a form, the sentences beside those that have faults, and the faults that have no place."""

    places: Mapping[str, Place]
    beside: Mapping[str, Sequence[str]]
    others: Sequence[Fault]

    @property
    def listed(self) -> list[tuple[Place, Sequence[str]]]:
        """Return the places that have faults, in the order of the faults, with their sentences."""
        return [(self.places[name], sentences) for name, sentences in self.beside.items()]


def placed(faults: Iterable[Fault], texts: Mapping[str, str]) -> PlacedFaults:
    """Return the faults at their places; one of a part that has no field stands at the row or list that holds it.

    One of a list of fixed length stands beside the field of its first item.
    """
    places = _places(texts)
    beside: dict[str, list[str]] = {}
    others = []
    for fault in faults:
        name, left = fault.pointer.removeprefix("/").replace("/", "."), ""
        while name and name not in places:
            if f"{name}.0" in places:  # a list of fixed length as a whole
                name += ".0"
                break
            name, _, last = name.rpartition(".")
            left = f"{last}.{left}" if left else last
        if name:
            beside.setdefault(name, []).append(f"{left}: {fault.detail}" if left else fault.detail)
        else:
            others.append(fault)
    return PlacedFaults(places, beside, others)


def of_typed(faults: Iterable[Fault], texts: Mapping[str, str]) -> list[Fault]:
    """Return the faults without those of rows into which nothing was typed yet."""
    blank = {
        row_lists()[name].row_name(number)
        for name, rows in rows_in(texts).items()
        for number, row in enumerate(rows)
        if is_blank(row)
    }
    return [fault for fault in faults if blank.isdisjoint(_holders(fault))]


def _holders(fault: Fault) -> Iterator[str]:
    """Yield the dotted names of the field at fault and of everything that holds it."""
    name = fault.pointer.removeprefix("/").replace("/", ".")
    while name:
        yield name
        name = name.rpartition(".")[0]


def _places(texts: Mapping[str, str]) -> dict[str, Place]:
    """Return every place; a row of plain values is its own field."""
    found = {name: Place(name, field.label) for name, field in form_fields().items()}
    for shown in shown_rows(texts).values():
        row_list = shown.row_list
        found[row_list.name] = Place(row_list.name, getattr(words().rows, row_list.name).all, is_field=False)
        for row in shown.rows:
            found |= {place.name: place for place in _row_places(row_list, row)}
    return found


def _row_places(row_list: RowList, row: ShownRow) -> Iterator[Place]:
    said = words().rows
    if row_list.is_plain:
        yield Place(row.name, row.label)
        return
    yield Place(row.name, row.label, is_field=False)
    if row_list.has_kinds:
        yield Place(f"{row.name}.{KIND}", f"{row.label}: {said.kind_of}")
    if row.rest is not None:
        yield Place(f"{row.name}.{REST}", f"{row.label}: {said.more}")
    for field in (field for part in row.parts for field in part.fields):
        yield Place(field.name, f"{row.label}: {field.label}")
