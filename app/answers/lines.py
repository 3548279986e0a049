"""Answers about lines: what resolving makes of a line as an engineer knows it."""

from typing import Any, Literal

from app.reference.source_lines import example
from app.schemas.fields import Answer, described, example_of

Number = float | None


class AssumptionRow(Answer):
    """Where one value of a line came from."""

    path: str = described("Dotted name of the field", "conductor.torsional_rigidity_n_m2")
    value: float = described("Its value, in the unit of the name", 173.2)
    unit: str = described("Unit; 1 for a number without one", "N m2")
    origin: Literal["given", "catalogue", "computed", "assumed"] = described(
        "Said in the line, read in a catalogue, computed from other values, or assumed", "assumed"
    )
    source: str = described("Where it came from, in a sentence", "energy of layers of helical wires that slide freely")
    lowest: Number = described("Lowest plausible value of an assumed one", 86.6)
    highest: Number = described("Highest plausible value of an assumed one", 346.4)


class SpanState(Answer):
    """The span of one sub-conductor under one load, at one temperature."""

    horizontal_tension_n: float = described("Horizontal tension [N]", 28024.0)
    largest_tension_n: float = described("Tension at the higher support [N]", 28130.0)
    sag_m: float = described("Sag from the chord [m]", 6.62)


class SpanStates(Answer):
    """The span every day and under ice; null where the iced tension was given."""

    everyday: SpanState | None = described("Bare, on an ordinary day", example_of(SpanState))
    iced: SpanState | None = described("Under ice, in still air", example_of(SpanState))


class ResolvedLine(Answer):
    """The explicit line of what is known, of which an analysis gives the same results."""

    line: dict[str, Any] = described("The explicit line document", example("c11-twin"))
    assumptions: list[AssumptionRow] = described("Where each value came from", [example_of(AssumptionRow)])
    states: SpanStates = described("Tension and sag", example_of(SpanStates))
    doubts: list[str] = described("Slips that the coefficients show, such as slopes per degree", [])
