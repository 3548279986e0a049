"""Which field an unknown one was meant to be, for the sentence of its fault."""

import re
from collections.abc import Mapping, Sequence
from difflib import get_close_matches
from functools import cache

# Words of engineers for fields whose names share nothing with them.
_OTHER_WORDS: Mapping[str, str] = {
    "rts": "rated_strength",
    "uts": "rated_strength",
    "rbs": "rated_strength",
    "breaking_load": "rated_strength",
    "modulus": "youngs_modulus",
    "elastic_modulus": "youngs_modulus",
    "e": "youngs_modulus",
    "ea": "axial_rigidity",
    "gj": "torsional_rigidity",
    "weight": "mass",
    "unit_weight": "mass",
    "conductors": "subconductors",
    "number": "subconductors",
    "span": "length",
    "span_length": "length",
    "h": "horizontal_tension",
    "gravity": "air_density",
}
_UNIT = re.compile(
    r"_(?:(?:k|m|c|k?lb|mm|cm|km|ft|in|g|kg|lbf|kip|n|kn|dan|nm|pa|kpa|mpa|gpa|psi|deg|rad|m2|mm2|in2|kmcil|mph|"
    r"kmh|kph|knots|c|f|t)(?:_(?:per_)?(?:m|km|ft|s|h|m2|m3|mm2|ft2|ft3|kft))*)$"
)
_CLOSE = 0.75
# Units that fields of requests do not have, as their names end and as `unit` takes them.
_UNITS = {name.casefold(): name for name in ("mm", "cm", "km", "ft", "in", "lb", "lbf", "kip", "kN", "daN", "kPa")} | {
    name.casefold(): name for name in ("MPa", "GPa", "psi", "mph", "mm2", "in2", "kcmil")
}


def meant(location: Sequence[object]) -> str:
    """Return the end of the sentence that says which field an unknown one was meant to be; empty if none is near.

    Parameters
    ----------
    location : sequence
        Tokens from the root of the request or of the line to the unknown name, without numbers of list items.
    """
    *path, name = (str(token)[:100] for token in location if not isinstance(token, int))
    wrapped = _wrapped(path, name)
    if wrapped:
        return wrapped
    if path and name in _siblings(path):
        return f"; {name} belongs to another form of {path[-1]} than the fields beside it"
    found = _nearest(name, _stems(tuple(path)))
    if found:
        return _said(name, found)
    wanted = _stem(name)
    elsewhere = _everywhere().get(_OTHER_WORDS.get(wanted, wanted))
    return f"; did you mean /{elsewhere.replace('.', '/')}?" if elsewhere else ""


def _wrapped(path: Sequence[str], name: str) -> str:
    """Return what to say of a line that is wrapped where it must not be, or not wrapped where it must."""
    parts, beside = _siblings(["line"]), set(_siblings([])) - {"line"}
    if not path and name in parts:
        return f'; {name} belongs into the line: {{"line": {{"{name}": ...}}}}'
    if path in ([], ["line"]) and name == "line":
        return "; the document is a line already, so give what stands in `line` without that name"
    if path == ["line"] and name in beside:
        return f"; {name} belongs beside the line, not into it"
    return ""


@cache
def _names() -> tuple[str, ...]:
    from app.schemas.field_table import field_names, input_fields  # noqa: PLC0415 - they are made of all schemas
    from app.schemas.known import KnownLine  # noqa: PLC0415 - see above

    names = [*(row["name"] for row in input_fields()), *(f"line.{name}" for name in field_names(KnownLine))]
    return tuple(dict.fromkeys(re.sub(r"\[[^]]*\]", "", name) for name in names))


def _siblings(path: Sequence[str]) -> list[str]:
    """Return the names of the fields beside the unknown one, whether the path begins at the request or the line."""
    for root in ([], ["line"], ["analysis"]):
        prefix = "".join(f"{token}." for token in [*root, *path])
        found = [full[len(prefix) :] for full in _names() if full.startswith(prefix)]
        if found:
            return [name for name in found if "." not in name]
    return []


def _stem(name: str) -> str:
    return _UNIT.sub("", name.casefold().replace("-", "_"))


@cache
def _stems(path: tuple[str, ...]) -> dict[str, str]:
    """Return the names of the fields at a path by their words without the unit."""
    return {_stem(known): known for known in reversed(_siblings(path))}


@cache
def _everywhere() -> dict[str, str]:
    """Return the dotted names of all fields by the words of their last part without the unit; the first one counts.

    Those of a climate count last: it has the words of a line in another sense.
    """
    names = sorted(_names(), key=lambda full: full.startswith("line.climate."))
    return {_stem(full.rpartition(".")[2]): full for full in reversed(names)}


def _nearest(name: str, stems: Mapping[str, str]) -> str | None:
    """Return the name with the same words but for the unit, or that contains them, or that is spelled alike."""
    wanted = _stem(name)
    wanted = _OTHER_WORDS.get(wanted, wanted) if wanted not in stems else wanted
    if wanted in stems:
        return stems[wanted]
    holding = [stem for stem in stems if set(wanted.split("_")) <= set(stem.split("_"))]
    close = [*holding[:1], *get_close_matches(wanted, stems, n=1, cutoff=_CLOSE)]
    return stems[close[0]] if close else None


def _said(name: str, found: str) -> str:
    unit = _UNITS.get(name[len(_stem(name)) + 1 :].casefold())
    if unit:
        return f'; did you mean {found}, perhaps as {{"value": ..., "unit": "{unit}"}}?'
    return f"; did you mean {found}?"
