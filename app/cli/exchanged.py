"""Read a line from a file of a GIS or CIM program for a command that works on one line."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from app.cli.console import BAD_INPUT, end, notice

if TYPE_CHECKING:
    from app.schemas.faults import Fault
    from app.sheets.columns import PlacedLine

SUFFIXES = frozenset({".geojson", ".rdf", ".xml"})
_MOST_BYTES = 20_000_000
_MOST_TEXT = 1_000_000
_NAMED = 5


def exchanged_request(path: Path, raw: bytes, defaults: Any) -> dict[str, Any]:
    """Return the request of a file that holds one line: its line, and the analysis if the file has one.

    What follows from coordinates is told on standard error. A file with several lines or a wrong one ends the command.
    """
    from app.exchange.cim import read_segments
    from app.exchange.features import read_features
    from app.schemas.faults import BadInput, BodyTooLarge
    from app.sheets.encodings import as_utf8

    members: Mapping[str, Any] = {}
    try:
        if path.suffix.lower() == ".geojson":
            features = read_features(as_utf8([raw]), _MOST_TEXT)
            members, lines, notes = features.members, list(features.lines), features.notes
        else:
            segments = read_segments([raw], defaults, _MOST_BYTES, _MOST_TEXT)
            lines, notes = list(segments.lines), segments.notes
        if defaults is not None and members.get("defaults") is not None:
            end(f"defaults are given twice: in {path} and by --defaults", BAD_INPUT)
        line = _only(path, lines)
        document = with_defaults(line, members.get("defaults") if defaults is None else defaults)
    except BadInput as error:
        _end_with(str(path), error.faults)
    except BodyTooLarge as error:
        end(f"{path}: {error}", BAD_INPUT)
    for sentence in notes.sentences():
        notice(sentence)
    return {"line": document, **{name: members[name] for name in ("analysis",) if name in members}}


def with_defaults(line: "PlacedLine", defaults: Any) -> dict[str, Any]:
    """Return the document of a line with what it leaves open, and tell what follows from its coordinates.

    Raises
    ------
    BadInput
        If the defaults are wrong, or the line is.
    """
    from app.exchange.defaults import checked_defaults, filled
    from app.schemas.faults import BadInput

    if isinstance(line.document, BadInput):
        raise line.document
    if line.faults:
        raise BadInput(line.faults)
    document, computed = filled(line.document, line.computed, checked_defaults(defaults))  # type: ignore[arg-type]
    for value in computed:
        notice(f"{value.name}: {value.value:.6g} {value.unit}, {value.source}")
    return {name: value for name, value in document.items() if name != "reference"}


def _only(path: Path, lines: Sequence["PlacedLine"]) -> "PlacedLine":
    if len(lines) != 1:
        named = ", ".join(line.place for line in lines[:_NAMED]) + (", ..." if len(lines) > _NAMED else "")
        end(f"{path} has {len(lines)} lines ({named}), not one; send all of them to a service as a batch", BAD_INPUT)
    return lines[0]


def _end_with(place: str, faults: Sequence["Fault"]) -> NoReturn:
    end("\n".join(f"{place}: {fault.detail if not fault.pointer else fault}" for fault in faults), BAD_INPUT)
