"""Faults of the engine, which name its attributes -> faults of a request document, which point into its JSON."""

from collections.abc import Sequence

from pydantic import BaseModel

from app import schemas
from app.schemas.faults import Fault, json_pointer
from engine import outcome


def to_pointer(fault: outcome.Fault, line: object, analysis: object) -> Fault:
    """Return a fault of the engine with the JSON pointer of its field.

    Parameters
    ----------
    fault : engine.outcome.Fault
    line, analysis : object
        What the attributes of the fault are looked up in: models, or `SoundParts` for the line.
    """
    path = fault.field.split(".")
    if path[0] == "analysis":
        path = path[1:]
    root, node = ("analysis", analysis) if path[0] in schemas.Analysis.model_fields else ("line", line)
    value = "" if fault.value is None else f", got {str(fault.value)[:80]}"
    return Fault(json_pointer([root, *json_names(node, path)]), "inconsistent", f"{fault.rule}{value}")


def json_names(node: object, path: Sequence[str]) -> list[str]:
    """Turn the engine's names into the contract's by walking the models, whose attributes carry the engine's names."""
    names: list[str] = []
    for token in path:
        if isinstance(node, BaseModel):
            fields = type(node).model_fields
            aliases = {info.alias for info in fields.values()}
            if token not in fields and token not in aliases:
                break  # a rule of several fields: it is told of what holds them
            names.append((fields[token].alias or token) if token in fields else token)
            node = getattr(node, token, None)
        elif isinstance(node, Sequence) and token.isdecimal():
            names.append(token)
            node = node[int(token)] if int(token) < len(node) else None
        else:
            names.append(token)
            node = getattr(node, token, None)
    return names
