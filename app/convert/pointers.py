"""Convert faults of the engine, which name its attributes, to faults with pointers into the JSON document."""

import math
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
        Models in which to look up the attributes of the fault, or `SoundParts` for the line.
    """
    path = fault.field.split(".")
    if path[0] == "analysis":
        path = path[1:]
    root, node = ("analysis", analysis) if path[0] in schemas.Analysis.model_fields else ("line", line)
    return at_names(fault, json_names(node, path), root)


def at_names(fault: outcome.Fault, names: Sequence[str], *roots: str) -> Fault:
    """Return a fault of the engine at the field of these JSON names below the roots, its value in the field's unit."""
    value = fault.value
    if isinstance(value, float) and names and names[-1].endswith("_deg"):
        value = round(math.degrees(value), 9)  # the engine's angles are in radians
    got = "" if value is None else f", got {str(value)[:80]}"
    return Fault(json_pointer([*roots, *names]), "inconsistent", f"{fault.rule}{got}")


def json_names(node: object, path: Sequence[str]) -> list[str]:
    """Convert the engine's names to JSON names by walking the models, whose attributes have the engine's names."""
    names: list[str] = []
    for token in path:
        if isinstance(node, BaseModel):
            fields = type(node).model_fields
            aliases = {info.alias for info in fields.values()}
            if token not in fields and token not in aliases:
                break  # a rule about several fields points to the object that contains them
            names.append((fields[token].alias or token) if token in fields else token)
            node = getattr(node, token, None)
        elif isinstance(node, Sequence) and token.isdecimal():
            names.append(token)
            node = node[int(token)] if int(token) < len(node) else None
        else:
            names.append(token)
            node = getattr(node, token, None)
    return names
