"""The catalogue of bare conductors that ships with the service: published figures as printed, with their sources."""

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

import app
from app.reference.catalogue_row import CatalogueRow, name_key
from app.reference.text_forms import folded

# Field -> published column and factor to SI.
_NUMBERS: Mapping[str, tuple[str, float]] = {
    "aluminium_wire_diameter_m": ("aluminium_wire_mm", 1e-3),
    "steel_wire_diameter_m": ("steel_wire_mm", 1e-3),
    "aluminium_area_m2": ("aluminium_area_mm2", 1e-6),
    "area_m2": ("area_mm2", 1e-6),
    "diameter_m": ("diameter_mm", 1e-3),
    "mass_kg_per_m": ("mass_kg_per_km", 1e-3),
    "rated_strength_n": ("rated_strength_kn", 1e3),
    "youngs_modulus_pa": ("modulus_gpa", 1e9),
    "thermal_expansion_per_k": ("expansion_per_mk", 1e-6),
}


def search(text: str, own: Sequence[CatalogueRow] = ()) -> list[CatalogueRow]:
    """Return the conductors whose name, designation, type or stranding contain every word of a text, ignoring case.

    An owner's own rows come first, and hide the shipped ones of the same name or designation.
    """
    words = folded(text).split()
    return [row for row in _with_own(own) if all(word in _searched(row) for word in words)]


@dataclass(frozen=True, slots=True)
class NamedRows:
    """Conductors by the keys of their designations and of their names."""

    by_designation: Mapping[str, Sequence[CatalogueRow]]
    by_name: Mapping[str, Sequence[CatalogueRow]]

    @classmethod
    def of(cls, rows: Iterable[CatalogueRow]) -> "NamedRows":
        """Sort rows by their keys, in their order."""
        listed = list(rows)
        return cls(_by_key(listed, "designation"), _by_key(listed, "name"))


def _by_key(rows: Iterable[CatalogueRow], field: str) -> dict[str, list[CatalogueRow]]:
    found: dict[str, list[CatalogueRow]] = {}
    for row in rows:
        found.setdefault(name_key(getattr(row, field)), []).append(row)
    return found


_NO_ROWS = NamedRows({}, {})


def named(name: str, own: NamedRows = _NO_ROWS) -> Sequence[CatalogueRow]:
    """Return the conductors of a designation, or if there are none, of a whole name, ignoring case; several may be.

    Among an owner's own rows, which come first, names come before designations.
    """
    wanted, listed = name_key(name), _shipped_names()
    places = (own.by_name, own.by_designation, listed.by_designation, listed.by_name)
    return next((found for place in places if (found := place.get(wanted))), [])


@cache
def _shipped_names() -> NamedRows:
    return NamedRows.of(shipped())


def _with_own(own: Sequence[CatalogueRow]) -> Iterator[CatalogueRow]:
    hidden = {name_key(row.name) for row in own}
    yield from own
    yield from (row for row in shipped() if hidden.isdisjoint({name_key(row.name), name_key(row.designation)}))


def _searched(row: CatalogueRow) -> str:
    return folded("\n".join((row.name, row.designation, row.type, row.stranding or "")))


@cache
def shipped() -> tuple[CatalogueRow, ...]:
    """Return every conductor that ships with the service."""
    sources = {source["id"]: source for source in _table("conductor_sources.csv")}
    return tuple(_row(printed, sources[printed["source"]]) for printed in _table("conductors.csv"))


def _table(name: str) -> list[dict[str, str]]:
    text = (files(app) / "data" / name).read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def _row(printed: Mapping[str, str], source: Mapping[str, str]) -> CatalogueRow:
    numbers = {name: _si(printed[column], factor) for name, (column, factor) in _NUMBERS.items()}
    diameter, mass = numbers.pop("diameter_m"), numbers.pop("mass_kg_per_m")
    assert diameter is not None, f"{printed['designation']} has no diameter"
    assert mass is not None, f"{printed['designation']} has no mass"
    return CatalogueRow(
        name=printed["name"],
        designation=printed["designation"],
        standard=printed["standard"],
        type=printed["type"],
        aluminium_wires=int(printed["aluminium_wires"]),
        steel_wires=int(printed["steel_wires"]),
        diameter_m=diameter,
        mass_kg_per_m=mass,
        source=source["title"],
        source_address=source["address"],
        licence=source["licence"],
        own=False,
        **numbers,
    )


def _si(printed: str, factor: float) -> float | None:
    # Six digits are more than any source prints; they hide what the factor adds in the last place.
    return float(f"{float(printed) * factor:.6g}") if printed else None
