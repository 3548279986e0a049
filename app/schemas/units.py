"""Numbers with a unit in a request, `{"value": 1000, "unit": "ft"}`: converted to the unit of their field."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache, lru_cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pint

_KEYS = frozenset({"value", "unit"})
_SHAPE = re.compile(r"[\w°%µ²³/*^(). -]{1,40}")
_TENS = re.compile(r"(?:1e|10\^|10\*\*)(-?\d)\s*/\s*(\w.*)")
_LARGE_POWER = re.compile(r"(\*\*|\^)\s*[-(]*\s*\d\d|\d{3}")
_POWER = re.compile(r"(?<=[A-Za-z])(?=[234])")
# Physical kinds as people say them, by pint's dimensions of mass, length, time and temperature.
_KINDS: Mapping[tuple[int, ...], str] = {
    (0, 1, 0, 0): "a length",
    (0, 2, 0, 0): "an area",
    (1, 0, 0, 0): "a mass",
    (1, 1, -2, 0): "a force",
    (1, -1, 0, 0): "a mass per length",
    (1, 0, -2, 0): "a force per length",
    (1, -1, -2, 0): "a pressure",
    (1, -3, 0, 0): "a density",
    (0, 1, -1, 0): "a speed",
    (0, 0, 0, 1): "a temperature",
    (0, 0, 0, 0): "a number or an angle",
}
_FORCES = {"a mass": "a force", "a mass per length": "a force per length"}
_EXAMPLES = {
    "m": "ft",
    "m2": "in2",
    "N": "lbf",
    "kg": "lb",
    "kg/m": "lb/ft",
    "N/m": "lbf/ft",
    "Pa": "psi",
    "kg/m3": "lb/ft3",
    "m/s": "mph",
    "degC": "degF",
    "deg": "rad",
}


@dataclass(frozen=True, slots=True)
class WrongUnit:
    """What stands for a number whose unit cannot be used; no schema accepts it, and its sentence becomes the fault."""

    sentence: str


def any_unit(values: Iterable[object]) -> bool:
    """Tell whether any of these is a number with its unit, or a list that may contain such."""
    for value in values:  # a loop, because it runs for every object of every request
        kind = type(value)
        if kind is dict:
            if "unit" in value and "value" in value:  # type: ignore[operator]
                return True
        elif kind is list and any_unit(value):  # type: ignore[arg-type]
            return True
    return False


def in_unit(value: Any, wanted: str) -> Any:
    """Return a value, or a list of values, in the unit of its field.

    Parameters
    ----------
    value : Any
        As it stands in the document; what has no unit is returned as it is.
    wanted : str
        Unit of the field, as the schema shows it.

    Returns
    -------
    Any
        Numbers; `WrongUnit` in place of those that cannot be converted.
    """
    if type(value) is list:
        return [in_unit(item, wanted) for item in value] if any_unit(value) else value
    return _converted(value, wanted) if any_unit([value]) else value


def _converted(given: Mapping[str, Any], wanted: str) -> Any:
    value, unit = given["value"], given["unit"]
    if given.keys() != _KEYS or not isinstance(unit, str):
        return WrongUnit('must be a number, or {"value": number, "unit": "..."} and nothing else')
    if isinstance(value, bool) or not isinstance(value, int | float):
        return WrongUnit("the value with a unit must be a number")
    scale = _scale(unit.strip(), wanted)
    if isinstance(scale, WrongUnit):
        return scale
    factor, offset = scale
    # Twelve digits are more than anybody knows, and hide what the conversion adds in the last place.
    return float(f"{factor * value:.12g}") if offset == 0.0 else round(factor * value + offset, 9) + 0.0


@lru_cache(maxsize=1024)
def _scale(unit: str, wanted: str) -> tuple[float, float] | WrongUnit:
    """Return the factor and the offset from a unit to the one that is wanted."""
    tens = _TENS.fullmatch(unit)
    if tens:
        rest = _scale(f"1/{tens[2]}", wanted)
        return rest if isinstance(rest, WrongUnit) else (10.0 ** int(tens[1]) * rest[0], 0.0)
    import pint  # noqa: PLC0415 - it takes half a second to load, and most requests have no units

    aim = _registry().Unit("" if wanted == "1" else _spelled(wanted))
    try:
        if not _SHAPE.fullmatch(unit) or _LARGE_POWER.search(unit):
            raise pint.UndefinedUnitError(unit)
        have = _registry().Unit(_spelled(unit))
        zero, one = (_registry().Quantity(number, have).to(aim).magnitude for number in (0.0, 1.0))
    except pint.DimensionalityError:
        return WrongUnit(_mismatch(unit, have, wanted, aim))
    except (pint.PintError, AttributeError, ValueError, TypeError, ArithmeticError, AssertionError):
        return WrongUnit(f"the unit {unit[:40]!r} is not known{_such_as(wanted)}")
    return float(one - zero), float(zero)


def _spelled(unit: str) -> str:
    """Write powers as pint reads them: kg/m3 becomes kg/m**3."""
    if "/" in unit:  # a difference of temperatures, as in 1/degF
        unit = re.sub(r"\bdeg([CF])\b", r"delta_deg\1", unit)
    return _POWER.sub("**", unit.replace("²", "2").replace("³", "3").replace("·", "*"))


@cache
def _registry() -> "pint.UnitRegistry[float]":
    import pint  # noqa: PLC0415 - see above

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)


def _mismatch(unit: str, have: "pint.Unit", wanted: str, aim: "pint.Unit") -> str:
    here, there = _kind(have), _kind(aim)
    meant = ""
    if _FORCES.get(here) == there:
        meant = unit.replace("lb", "lbf").replace("kg", "kgf")
    elif _FORCES.get(there) == here:
        meant = unit.replace("lbf", "lb").replace("kgf", "kg")
    hint = f"; say {meant}" if meant not in {"", unit} else _such_as(wanted)
    return f"{unit} is {here}, but {there} is wanted{hint}"


def _kind(unit: "pint.Unit") -> str:
    powers: dict[str, Any] = dict(unit.dimensionality)
    key = tuple(int(powers.pop(f"[{name}]", 0)) for name in ("mass", "length", "time", "temperature"))
    return _KINDS.get(key, f"of the unit {unit:~}") if not powers else f"of the unit {unit:~}"


def _such_as(wanted: str) -> str:
    if wanted == "1":
        return "; the field has no unit"
    return f"; say {wanted} or {_EXAMPLES[wanted]}" if wanted in _EXAMPLES else f"; say {wanted}"
