"""What goes out without any job: the conductor catalogue, the fields of a request, and the tables of a result."""

from typing import Any, Literal

from app.schemas.fields import Answer, example_of, told

Number = float | None


class ConductorRow(Answer):
    """A bare conductor; a line's `conductor` takes diameter, area and modulus as they are, mass with the ice added."""

    name: str = told("Code word or usual name", "Drake")
    designation: str = told("Designation of its standard", "795 kcmil 26/7")
    type: Literal["ACSR", "AACSR", "AAC"] = told(
        "Aluminium (AAC), with steel core (ACSR), or aluminium alloy with steel core (AACSR)", "ACSR"
    )
    stranding: str = told("Wires of aluminium / of steel", "26/7")
    area_m2: float = told("Area of all wires [m2]", 4.685e-4)
    diameter_m: float = told("Overall diameter [m]", 0.02811)
    mass_kg_per_m: float = told("Mass per length, bare [kg/m]", 1.628)
    rated_strength_n: Number = told("Rated tensile strength; null where the source has none [N]", 140100.0)
    youngs_modulus_pa: Number = told("Final modulus; null where the source has none [Pa]", 7.4e10)
    source: str = told("Where the figures are from", "Aluminum Association values for ACSR")


class ConductorList(Answer):
    """Conductors of the catalogue."""

    conductors: list[ConductorRow] = told("The rows found", [example_of(ConductorRow)])


class FieldRow(Answer):
    """One field of a request."""

    name: str = told(
        "Dotted name; [] follows a list, [spacer] the type of its items", "line.conductor.axial_torsional_coupling_n_m"
    )
    type: str = told("Type of JSON, or several", "number")
    unit: str | None = told("Unit; null if it has none", "N m")
    required: bool = told("Whether it must be given", False)
    nullable: bool = told("Whether null may be given", False)
    default: Any = told("What holds if it is absent; null for nothing", 0.0)
    minimum: Number = told("Smallest value, in a list that of its items", -1e6)
    maximum: Number = told("Largest value, in a list that of its items", 1e6)
    fewest_items: int | None = told("Shortest list", 3)
    most_items: int | None = told("Longest list", 3)
    choices: list[str] | None = told("Words that it takes, if only these", ["constant_coefficient", "constant_ratio"])
    description: str = told("What it is", "Axial-torsional coupling B_T [N m]")
    example: Any = told("A usual value", 0.0)


class FieldList(Answer):
    """Every field of a request, in the order of the document."""

    fields: list[FieldRow] = told("The fields", [example_of(FieldRow)])


class ColumnRow(Answer):
    """One column of a result table; any value may be null where nothing is known."""

    name: str = told("Name in JSON, CSV and Parquet", "vertical_m")
    kind: Literal["number", "integer", "truth", "text"] = told("What its values are", "number")
    unit: str | None = told("Unit; null if it is no number", "m")
    description: str = told("What it holds", "Vertical amplitude")
    example: Any = told("A usual value", 0.1568)


class TableRow(Answer):
    """One table of a result."""

    name: str = told("Name in the result document", "limit_cycles")
    address: str = told("Name in addresses, `/results/limit-cycles`", "limit-cycles")
    title: str = told("What it holds", "Motions at every wind speed")
    columns: list[ColumnRow] = told("Its columns in order", [example_of(ColumnRow)])


class TableList(Answer):
    """Every table of a result, in the order of the document."""

    tables: list[TableRow] = told("The tables", [example_of(TableRow)])
