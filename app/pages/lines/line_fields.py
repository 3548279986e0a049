"""The fields of the form of a line, with unit, bounds, default and help as the schemas have them."""

from collections.abc import Callable, Iterator, Mapping, Sequence
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
    "coefficients": (
        "line.ice.aerodynamics.reference_diameter_m",
        "line.ice.aerodynamics.angle_deg",
        "line.ice.aerodynamics.vertical",
        "line.ice.aerodynamics.horizontal",
        "line.ice.aerodynamics.torsional",
        "line.ice.aerodynamics.fitted_range_deg",
        "line.ice.aerodynamics_at_rest.vertical",
        "line.ice.aerodynamics_at_rest.horizontal",
        "line.ice.aerodynamics_at_rest.torsional",
        "line.ice.eccentricity_y_m",
        "line.ice.eccentricity_z_m",
        "line.ice.aerodynamics.static_angle_deg",
        "line.ice.aerodynamics.half_range_deg",
        "line.ice.aerodynamics.table",
    ),
    "pieces": ("line.ice.segments",),
    "devices": ("line.devices",),
    "phases": ("line.required_clearance_m", "line.phases"),
    "supports": (
        "line.supports.left.adjacent_span_m",
        "line.supports.left.insulator_length_m",
        "line.supports.right.adjacent_span_m",
        "line.supports.right.insulator_length_m",
    ),
    "section": ("line.section.span_of_interest", "line.section.spans", "line.section.strings"),
    "wind": ("line.wind.air_density_kg_per_m3", "line.wind.yaw_deg", "line.wind.profile"),
    "damping": ("line.damping.vertical_ratio", "line.damping.horizontal_ratio", "line.damping.torsional_ratio"),
    "climate": ("line.climate.line_azimuth_deg", "line.climate.sectors", "line.climate.icing"),
    "figures": (
        "line.conductor.diameter_m",
        "line.conductor.bare_mass_kg_per_m",
        "line.conductor.mass_kg_per_m",
        "line.conductor.polar_inertia_kg_m",
        "line.conductor.axial_rigidity_n",
        "line.conductor.torsional_rigidity_n_m2",
        "line.conductor.rated_strength_n",
    ),
    "analysis": (
        "line.design_wind_m_per_s",
        "analysis.wind_speeds_m_per_s.start",
        "analysis.wind_speeds_m_per_s.stop",
        "analysis.wind_speeds_m_per_s.count",
        "analysis.wind_speeds_m_per_s",
        "analysis.check",
    ),
}
"""The groups of the form, by the dotted names of a request: those of fields, and those of lists that have rows."""

CLOSED = frozenset({"coefficients", "pieces", "supports", "section", "wind", "damping", "climate", "figures"})
"""Groups that a page shows on demand."""

_VALUES = frozenset({"number", "integer", "string"})
_POWERS = ("", "²", "³")
_NULL = "if null"  # of JSON; a field of a form is left empty
_MILLI = 1e3
_SMALL_M = 0.5  # what is never larger than this is entered in millimetres or inches
_DIGITS = 12
_CONVERTED_DIGITS = 7


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of the form: its row in the table of fields, and the unit in which the reader enters it.

    said: the name of its words; part: the object within a row of a list that holds it, empty for the row itself.
    """

    name: str
    row: Mapping[str, Any]
    said: str
    part: str = ""

    @property
    def key(self) -> str:
        """Return the name as an id of HTML."""
        return key_of(self.name)

    @property
    def pointer(self) -> str:
        """Return the JSON pointer of the field."""
        return "/" + self.name.replace(".", "/")

    @property
    def label(self) -> str:
        """Return the name in words."""
        return word_for(words().fields, self.said)

    @property
    def is_number(self) -> bool:
        """Tell whether the field holds a number."""
        return self.row["type"] in {"number", "integer"}

    def unit(self, units: Units) -> Unit:
        """Return the unit in which the field is entered; millimetres or inches for what is small."""
        if self.row["unit"] == "m" and (self.row["maximum"] or _MILLI) <= _SMALL_M:
            return Unit("mm", _MILLI) if not units.instead else Unit("in", 1 / 0.0254)
        return units.unit(self.row["unit"])

    def entered(self, value: float, units: Units) -> str:
        """Return a number of the request in the unit in which it is entered."""
        unit = self.unit(units)
        digits = _CONVERTED_DIGITS if units.instead else _DIGITS
        return f"{value * unit.factor + unit.offset:.{digits}g}"

    def hint(self, units: Units) -> str:
        """Return what the field means, with its bounds and its default."""
        said, row = words().line, self.row
        about = row["description"].partition(" [")[0].replace("`", "")
        parts = [about.replace(_NULL, said.empty) + "."]
        if self.is_number and row["minimum"] is not None and row["maximum"] is not None:
            low, high = (self.entered(row[end], units) for end in ("minimum", "maximum"))
            parts.append(_closed(said.bounds.format(low=low, high=high, unit=self.unit(units).name)))
        default = row["default"]
        if default not in (None, ""):
            shown = f"{self.entered(default, units)} {self.unit(units).name}" if self.is_number else default
            parts.append(_closed(said.default.format(value=shown)))
        return " ".join(parts)


def key_of(name: str) -> str:
    """Return a dotted name as an id of HTML."""
    return name.replace(".", "-")


@cache
def form_fields() -> dict[str, FormField]:
    """Return the fields of the form by their dotted names, without those of rows.

    Raises
    ------
    KeyError
        If the schemas lack one of them.
    """
    return {field.name: field for name in _named() for field in fields_at(name, schema_rows()[name], _said)}


def list_names() -> tuple[str, ...]:
    """Return the dotted names of the lists that have rows in the form."""
    return tuple(name for name in _named() if not is_value(row := schema_rows()[name]) and not has_fixed_length(row))


def controls(group: str) -> list[str]:
    """Return the dotted names of the controls of a group: its fields, and its lists that have rows."""
    lists = list_names()
    return [
        control
        for name in GROUPS[group]
        for control in (
            [name] if name in lists else [field.name for field in fields_at(name, schema_rows()[name], str)]
        )
    ]


def fields_at(path: str, row: Mapping[str, Any], said: Callable[[str], str], part: str = "") -> Iterator[FormField]:
    """Yield the field of a value, or those of a list of fixed length, one for each item; none of anything else.

    said: returns the name of the words of a field.
    """
    if is_value(row):
        yield FormField(path, row, said(path), part)
    elif has_fixed_length(row):
        for number in range(row["most_items"]):
            name = f"{path}.{number}"
            unit = row["unit"] and row["unit"].replace("^j", _POWERS[number])
            item = {**row, "type": "number" if row["unit"] else "string", "unit": unit}
            yield FormField(name, item, said(name), part)


def is_value(row: Mapping[str, Any]) -> bool:
    """Tell whether a row of the table of fields is that of a number or a text."""
    return row["type"] in _VALUES


def has_fixed_length(row: Mapping[str, Any]) -> bool:
    """Tell whether a row of the table of fields is that of a list which always has as many items."""
    return row["type"] == "array" and row["most_items"] is not None and row["fewest_items"] == row["most_items"]


@cache
def schema_rows() -> dict[str, Mapping[str, Any]]:
    """Return the rows of the table of fields of a request, whose line may have any form, by their dotted names."""
    rows = {f"line.{row['name']}": row for row in reversed(fields_of(KnownLine))}
    return rows | {row["name"]: row for row in input_fields() if row["name"].startswith("analysis.")}


def _named() -> list[str]:
    return [name for names in GROUPS.values() for name in names]


def _said(name: str) -> str:
    """Return the name of the words of a field: its own, else those that it shares with rows that have such a part."""
    return name if hasattr(words().fields, name) else name.removeprefix("line.")


def _closed(sentence: str) -> str:
    return sentence.replace(" .", ".")
