"""Lines as engineers know them, to the engine and back to an explicit document; numerics are loaded with the first."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from app.convert.known.own_rows import OwnRows
from app.schemas.faults import BadInput, Fault, faults_of
from app.schemas.known import KnownLine

__all__ = ["OwnRows", "explicit_line", "explicit_request", "is_known_form", "resolve_document", "resolve_line"]

_NO_OWN_ROWS = OwnRows()
_FORMS: Mapping[str, frozenset[str]] = {
    "conductor": frozenset(
        {
            "catalogue",
            "bare_mass_kg_per_m",
            "bare_polar_inertia_kg_m",
            "aluminium_area_m2",
            "thermal_expansion_per_k",
            "aluminium_wires",
            "steel_wires",
        }
    ),
    "bundle": frozenset({"spacing_m", "arrangement"}),
    "span": frozenset({"everyday", "ruling_span_m", "temperature_c"}),
    "ice": frozenset({"accretion"}),
}
_OF_AERODYNAMICS = frozenset({"catalogue", "reference_diameter_m"})
_OF_LINE = frozenset({"phases", "required_clearance_m", "design_wind_m_per_s"})


def is_known_form(line: object) -> bool:
    """Tell whether a line document has a form that the explicit line has not."""
    if not isinstance(line, dict):
        return False
    ice = line.get("ice")
    coefficients = ice.get("aerodynamics") if isinstance(ice, dict) else None
    parts = [(line.get(name), forms) for name, forms in _FORMS.items()]
    return any(
        isinstance(part, dict) and not forms.isdisjoint(part)
        for part, forms in (*parts, (coefficients, _OF_AERODYNAMICS), (line, _OF_LINE))
    )


def explicit_line(line: object, own: OwnRows = _NO_OWN_ROWS) -> Any:
    """Return a line document as it is, or resolved if it has a form that the explicit line has not.

    Raises
    ------
    BadInput
        As in `resolve_document`.
    """
    return resolve_document(line, own)["line"] if is_known_form(line) else line


def explicit_request(document: Any, own: OwnRows = _NO_OWN_ROWS) -> Any:
    """Return a request document whose line is explicit.

    Raises
    ------
    BadInput
        As in `resolve_document`, with pointers from the root of the request.
    """
    if not isinstance(document, dict) or not is_known_form(document.get("line")):
        return document
    try:
        return {**document, "line": explicit_line(document["line"], own)}
    except BadInput as error:
        raise BadInput([Fault(f"/line{f.pointer}", f.code, f.detail) for f in error.faults]) from error


def resolve_document(document: object, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Check a line document in any of its forms, and resolve it.

    Raises
    ------
    BadInput
        With every fault of the schema, else as in `resolve_line`.
    """
    try:
        line = KnownLine.model_validate(document)
    except ValidationError as error:
        raise BadInput(faults_of(error.errors(include_url=False))) from error
    return resolve_line(line, own)


def resolve_line(line: KnownLine, own: OwnRows = _NO_OWN_ROWS) -> dict[str, Any]:
    """Return the explicit line of what is known, as `app.convert.known.to_document` says.

    Raises
    ------
    BadInput
        With every fault of the parts, or of the line as a whole.
    """
    from app.convert.known.to_document import resolved_document  # noqa: PLC0415 - the API needs no numerics to start

    return resolved_document(line, own)
