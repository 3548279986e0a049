"""Answers with reference data: conductors, ice shapes, the fields of a request, and the tables of a result."""

from typing import Any, Literal

from app.schemas.fields import Answer, described, example_of

Number = float | None


class Version(Answer):
    """What runs here."""

    service: str = described("Version of the service", "0.4.0")
    engine: str = described("Version of the computation; stored results of another one are not reused", "0.4.0")
    api: str = described("First part of the addresses", "v1")


class ConductorRow(Answer):
    """A bare conductor; a line's `conductor` takes diameter, area, modulus and strength unchanged, mass with ice."""

    name: str = described("Code word or usual name", "Drake")
    designation: str = described("Designation of its standard", "795 kcmil 26/7")
    standard: str = described("Standard that describes it", "ASTM B232")
    type: str = described(
        "Aluminium (AAC), alloy (AAAC), with steel core (ACSR), alloy with steel core (AACSR), or an owner's own word",
        "ACSR",
    )
    stranding: str | None = described("Wires of aluminium / of steel", "26/7")
    aluminium_wire_diameter_m: Number = described(
        "Diameter of a wire of aluminium; null where the source has none [m]", None
    )
    steel_wire_diameter_m: Number = described("Diameter of a wire of steel; null where the source has none [m]", None)
    aluminium_area_m2: Number = described("Area of the wires of aluminium [m2]", 4.028e-4)
    area_m2: Number = described("Area of all wires; null where the source has none [m2]", 4.6864e-4)
    diameter_m: float = described("Overall diameter [m]", 0.02814)
    mass_kg_per_m: float = described("Mass per length, bare [kg/m]", 1.6281)
    rated_strength_n: Number = described("Rated tensile strength; null where the source has none [N]", 140120.0)
    youngs_modulus_pa: Number = described("Final modulus; null where the source has none [Pa]", 6.964e10)
    thermal_expansion_per_k: Number = described("Thermal expansion; null where the source has none [1/K]", 1.882e-5)
    source: str = described("Source of the figures", "ASTM B232/B232M-11, Table 1")
    source_address: str | None = described(
        "Where the source was read; null for own rows",
        "https://github.com/OverheadTransmissionLineSoftware/SpanAnalyzer",
    )
    licence: str | None = described("Licence of the source; null for own rows", "Unlicense (public domain)")
    own: bool = described("Whether it is the owner's own row", False)


class ConductorList(Answer):
    """Conductors of the catalogue."""

    conductors: list[ConductorRow] = described("The rows found", [example_of(ConductorRow)])


class ShapeCoefficients(Answer):
    """Cubic coefficients over the angle of attack in radians, as a line's `aerodynamics` takes them."""

    vertical: list[float] = described("a_y1, a_y2, a_y3 [1/rad, 1/rad2, 1/rad3]", [-0.1667, -4.0547, 8.3581])
    horizontal: list[float] = described("a_z1, a_z2, a_z3 [1/rad, 1/rad2, 1/rad3]", [0.8605, 0.8325, 1.7815])
    torsional: list[float] = described(
        "a_theta1, a_theta2, a_theta3 [1/rad, 1/rad2, 1/rad3]", [-0.7272, 0.2935, 5.9704]
    )


class ShapeAtRest(Answer):
    """Coefficients at the static angle, as a line's `aerodynamics_at_rest` takes them."""

    vertical: float = described("a_y0 [1]", 0.0)
    horizontal: float = described("a_z0 [1]", 1.0)
    torsional: float = described("a_theta0 [1]", 0.0)


class IceShapeRow(Answer):
    """An ice shape with the aerodynamic coefficients of one iced sub-conductor, as its source gives them."""

    name: str = described('Name for `{"catalogue": name}` in a line\'s `aerodynamics`', "c11-40")
    title: str = described("What the shape is", "C11, natural glaze from freezing rain, at 40 degrees")
    static_angle_deg: float = described("Angle of the ice at which the coefficients hold [deg]", 40.0)
    aerodynamics: ShapeCoefficients = described("Coefficients, slopes per radian", example_of(ShapeCoefficients))
    aerodynamics_at_rest: ShapeAtRest | None = described("Coefficients at rest; null if the source has none", None)
    fitted_range_deg: Number = described("Largest angle of attack of the fit; null if not stated [deg]", None)
    reynolds_number: Number = described("Reynolds number of the measurement; null if not stated [1]", None)
    reference_diameter_m: float = described("Diameter over which forces are taken, moments over its square [m]", 0.0286)
    reference: Literal["bare", "iced"] = described(
        "Whether that is the diameter of the bare or the iced section", "bare"
    )
    source: str = described("Where the coefficients were read", "Galloping of bundle conductor, Table 3")
    caveats: list[str] = described("What to bear in mind", ["Other ice has other coefficients."])


class IceShapeList(Answer):
    """Every ice shape whose coefficients were read in a named source."""

    ice_shapes: list[IceShapeRow] = described("The shapes", [example_of(IceShapeRow)])


class FieldRow(Answer):
    """One field of a request."""

    name: str = described(
        "Dotted name; [] follows a list, [spacer] the type of its items", "line.conductor.axial_torsional_coupling_n_m"
    )
    type: str = described("JSON type, or several types", "number")
    unit: str | None = described("Unit; null if it has none", "N m")
    required: bool = described("Whether it must be given", False)
    nullable: bool = described("Whether null may be given", False)
    default: Any = described("Value of an absent field; null if there is none", 0.0)
    minimum: Number = described("Smallest value; for a list, of its items", -1e6)
    maximum: Number = described("Largest value; for a list, of its items", 1e6)
    fewest_items: int | None = described("Fewest items of a list", 3)
    most_items: int | None = described("Most items of a list", 3)
    choices: list[str] | None = described("Allowed words, if only these", ["constant_coefficient", "constant_ratio"])
    description: str = described("Meaning of the field", "Axial-torsional coupling B_T [N m]")
    example: Any = described("A typical value", 0.0)


class FieldList(Answer):
    """Every field of a request, in the order of the document."""

    fields: list[FieldRow] = described("The fields", [example_of(FieldRow)])


class ColumnRow(Answer):
    """One column of a result table; any value may be null where nothing is known."""

    name: str = described("Name in JSON, CSV and Parquet", "vertical_m")
    kind: Literal["number", "integer", "truth", "text"] = described("Type of the values", "number")
    unit: str | None = described("Unit; null if it is no number", "m")
    description: str = described("Meaning of the column", "Vertical amplitude")
    example: Any = described("A typical value", 0.1568)


class TableRow(Answer):
    """One table of a result."""

    name: str = described("Name in the result document", "limit_cycles")
    address: str = described("Name in addresses, `/results/limit-cycles`", "limit-cycles")
    title: str = described("Content of the table", "Motions at every wind speed")
    columns: list[ColumnRow] = described("Its columns in order", [example_of(ColumnRow)])


class TableList(Answer):
    """Every table of a result, in the order of the document."""

    tables: list[TableRow] = described("The tables", [example_of(TableRow)])
