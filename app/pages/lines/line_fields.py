"""The fields of the form of a line, with unit, bounds, default and help as the schemas have them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from app.pages.measures import Unit, Units
from app.pages.wording import word_for, words
from app.schemas.field_table import fields_of, input_fields
from app.schemas.known import KnownLine

GROUPS: Mapping[str, Sequence[str]] = {
    "identity": ("line.name", "line.asset_id"),
    "conductor": ("line.conductor.catalogue",),
    "bundle": ("line.bundle.subconductors", "line.bundle.spacing_m", "line.bundle.arrangement"),
    "span": ("line.span.length_m", "line.span.level_difference_m", "line.span.ruling_span_m"),
    "everyday": (
        "line.span.everyday.temperature_c",
        "line.span.everyday.share_of_rated_strength",
        "line.span.everyday.horizontal_tension_n",
        "line.span.everyday.sag_m",
    ),
    "iced": ("line.span.temperature_c", "line.span.horizontal_tension_n"),
    "ice": (
        "line.ice.accretion.shape",
        "line.ice.accretion.thickness_m",
        "line.ice.accretion.mass_kg_per_m",
        "line.ice.accretion.kind",
        "line.ice.accretion.density_kg_per_m3",
        "line.ice.accretion.angle_deg",
        "line.ice.aerodynamics.catalogue",
    ),
    "supports": (
        "line.supports.left.adjacent_span_m",
        "line.supports.left.insulator_length_m",
        "line.supports.right.adjacent_span_m",
        "line.supports.right.insulator_length_m",
    ),
    "damping": ("line.damping.vertical_ratio", "line.damping.horizontal_ratio", "line.damping.torsional_ratio"),
    "figures": (
        "line.conductor.diameter_m",
        "line.conductor.bare_mass_kg_per_m",
        "line.conductor.mass_kg_per_m",
        "line.conductor.polar_inertia_kg_m",
        "line.conductor.axial_rigidity_n",
        "line.conductor.torsional_rigidity_n_m2",
        "line.conductor.rated_strength_n",
        "line.wind.air_density_kg_per_m3",
        "line.required_clearance_m",
    ),
    "analysis": (
        "analysis.wind_speeds_m_per_s.start",
        "analysis.wind_speeds_m_per_s.stop",
        "analysis.wind_speeds_m_per_s.count",
        "analysis.check",
    ),
}
"""The groups of fields of the form, by the dotted names of a request."""

CLOSED = frozenset({"supports", "damping", "figures"})
"""Groups that a page shows on demand."""

_SMALL = frozenset({"line.ice.accretion.thickness_m", "line.conductor.diameter_m"})
_MILLI = 1e3


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of the form: its row in the table of fields, and the unit in which the reader enters it."""

    name: str
    row: Mapping[str, Any]

    @property
    def key(self) -> str:
        """Return the name as an id of HTML."""
        return self.name.replace(".", "-")

    @property
    def pointer(self) -> str:
        """Return the JSON pointer of the field."""
        return "/" + self.name.replace(".", "/")

    @property
    def label(self) -> str:
        """Return the name in words."""
        return word_for(words().fields, self.name)

    @property
    def is_number(self) -> bool:
        """Tell whether the field holds a number."""
        return self.row["type"] in {"number", "integer"}

    def unit(self, units: Units) -> Unit:
        """Return the unit in which the field is entered; millimetres or inches for what is small."""
        if self.name in _SMALL:
            return Unit("mm", _MILLI) if not units.instead else Unit("in", 1 / 0.0254)
        return units.unit(self.row["unit"])

    def entered(self, value: float, units: Units) -> str:
        """Return a number of the request in the unit in which it is entered."""
        unit = self.unit(units)
        return f"{value * unit.factor + unit.offset:.7g}"

    def hint(self, units: Units) -> str:
        """Return what the field means, with its bounds and its default."""
        said, row = words().line, self.row
        parts = [row["description"].partition(" [")[0].replace("`", "") + "."]
        if self.is_number and row["minimum"] is not None and row["maximum"] is not None:
            low, high = (self.entered(row[end], units) for end in ("minimum", "maximum"))
            parts.append(said.bounds.format(low=low, high=high, unit=self.unit(units).name).replace(" .", "."))
        if row["default"] not in (None, ""):
            parts.append(said.default.format(value=row["default"]))
        return " ".join(parts)


@cache
def form_fields() -> dict[str, FormField]:
    """Return the fields of the form by their dotted names.

    Raises
    ------
    KeyError
        If the schemas lack one of them.
    """
    rows = {f"line.{row['name']}": row for row in reversed(fields_of(KnownLine))}
    rows |= {row["name"]: row for row in input_fields() if row["name"].startswith("analysis.")}
    return {name: FormField(name, rows[name]) for names in GROUPS.values() for name in names}
