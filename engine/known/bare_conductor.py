"""The bare conductor: what is given, else what its row of a catalogue says, else estimates."""

from collections.abc import Iterator, Mapping
from typing import Any

from engine.known import estimators
from engine.known.description import KnownConductor
from engine.known.estimate import Estimate
from engine.known.provenance import Assumption, Provenance, assumed, computed, from_catalogue, given
from engine.known.wires import Wires, areas_from_mass
from engine.outcome import Fault, InvalidSpec

_UNITS: Mapping[str, str] = {
    "diameter": "m",
    "bare_mass": "kg/m",
    "area": "m2",
    "aluminium_area": "m2",
    "modulus": "Pa",
    "axial_rigidity": "N",
    "torsional_rigidity": "N m2",
    "axial_torsional_coupling": "N m",
    "bare_polar_inertia": "kg m",
    "rated_strength": "N",
    "thermal_expansion": "1/K",
}
_NAMED = "must be given, or a conductor of the catalogue that has it be named"


def bare_conductor(known: KnownConductor, chosen: Mapping[str, float], *, bare: bool) -> Provenance:
    """Return the values of a conductor.

    Parameters
    ----------
    known : KnownConductor
    chosen : mapping
        Values that replace estimates, by path.
    bare : bool
        Whether the line needs the bare conductor's mass, inertia and expansion: for an accretion or a change of state.

    Returns
    -------
    Provenance
        Paths `conductor.*` of `ConductorData`. Figures that nothing needs are left out unless they are known.

    Raises
    ------
    InvalidSpec
        If diameter or mass are needed and not known.
    """
    told = {name: row for name in _UNITS if (row := _told(known, name)) is not None}
    missing = [name for name in ("diameter", *(("bare_mass",) if bare else ())) if name not in told]
    if missing:
        raise InvalidSpec(*(Fault(f"conductor.{name}", None, _NAMED) for name in missing))
    rows = Provenance(tuple(told[name] for name in ("diameter", "bare_mass") if name in told))
    wires, metal = _metal(known, told, chosen)
    stranded = wires.aluminium_wires is not None
    if bare or "axial_rigidity" not in told or ("torsional_rigidity" not in told and stranded):
        rows = rows.extended(metal)
    rows = rows.extended(_rigidities(told, wires, rows, chosen))
    if bare:
        rows = rows.extended(_bare_figures(told, wires, rows, chosen))
    return rows.extended(told[name] for name in ("axial_torsional_coupling", "rated_strength") if name in told)


def _told(known: KnownConductor, name: str) -> Assumption | None:
    """Return a figure that is given or in the catalogue, None if neither has it."""
    path, unit = f"conductor.{name}", _UNITS[name]
    stated = getattr(known.given, name)
    if stated is not None:
        return given(path, stated, unit)
    listed = None if known.row is None else getattr(known.row.data, name)
    if known.row is None or listed is None:
        return None
    return from_catalogue(path, listed, unit, f"{known.row.name}: {known.row.source}")


def _metal(
    known: KnownConductor, told: Mapping[str, Assumption], chosen: Mapping[str, float]
) -> tuple[Wires, list[Assumption]]:
    """Return the wires of a conductor, with the rows that are needed for them."""
    diameter = told["diameter"].value
    area = told.get("area") or assumed("conductor.area", estimators.area_of_circle(diameter), chosen)
    counts = (_wires(known, "aluminium_wires"), _wires(known, "steel_wires"))
    aluminium = told.get("aluminium_area")
    if aluminium is None and "bare_mass" in told and counts[1] != 0:
        share, _ = areas_from_mass(area.value, told["bare_mass"].value)
        source = "from area and mass, with 2,700 kg/m3 of aluminium and 7,780 kg/m3 of steel"
        aluminium = computed("conductor.aluminium_area", share, "m2", source)
    pure = area.value if aluminium is None else min(aluminium.value, area.value)
    rows = [area] if aluminium is None else [area, aluminium]
    return Wires(pure, area.value - pure, diameter, *counts), rows


def _wires(known: KnownConductor, name: str) -> int | None:
    stated: Any = getattr(known.given, name)
    if stated is None and known.row is not None:
        stated = getattr(known.row.data, name)
    return None if stated is None else int(stated)


def _rigidities(
    told: Mapping[str, Assumption], wires: Wires, rows: Provenance, chosen: Mapping[str, float]
) -> Iterator[Assumption]:
    if "axial_rigidity" in told:
        yield told["axial_rigidity"]
    else:
        modulus = told.get("modulus") or assumed("conductor.modulus", estimators.modulus(wires), chosen)
        rigidity = modulus.value * rows["conductor.area"]
        yield modulus
        yield computed("conductor.axial_rigidity", rigidity, "N", "modulus times area")
    stranded = wires.aluminium_wires is not None
    yield told.get("torsional_rigidity") or assumed(
        "conductor.torsional_rigidity",
        estimators.torsional_rigidity(wires) if stranded else estimators.torsional_rigidity_of_diameter(wires.diameter),
        chosen,
    )


def _bare_figures(
    told: Mapping[str, Assumption], wires: Wires, rows: Provenance, chosen: Mapping[str, float]
) -> Iterator[Assumption]:
    mass = rows["conductor.bare_mass"]
    inertia: Estimate = estimators.polar_inertia(wires, mass)
    yield told.get("bare_polar_inertia") or assumed("conductor.bare_polar_inertia", inertia, chosen)
    expansion = estimators.thermal_expansion(wires)
    yield told.get("thermal_expansion") or assumed("conductor.thermal_expansion", expansion, chosen)
