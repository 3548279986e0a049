"""Numbers as pages show them: in SI, or in feet and pounds, with as many digits as are known."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import floor, log10

_IN_TEXT = re.compile(r"(?<![\w.])(?:(-?\d+(?:\.\d+)?) to )?(-?\d+(?:\.\d+)?) (m/s|m|N|kg)(?![\w/])")
_DIGITS = 3
_NO_NUMBER = "\N{EN DASH}"
_FROM_TEN_THOUSAND = 4  # below a power of ten of this size numbers are written out


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit as it is shown, and its value for one and for zero of the SI unit."""

    name: str
    factor: float = 1.0
    offset: float = 0.0
    sent: str = ""

    @property
    def in_requests(self) -> str:
        """Return how a request says the unit."""
        return self.sent or self.name


@dataclass(frozen=True, slots=True)
class Units:
    """A choice of units: the one that stands for each SI unit of a field or column."""

    name: str
    instead: Mapping[str, Unit] = field(default_factory=dict)

    def unit(self, si: str | None) -> Unit:
        """Return the unit in which a quantity of this SI unit is shown."""
        return self.instead.get(si or "", Unit(_SPELLED.get(si or "", si or "")))

    def value(self, number: float, si: str | None) -> float:
        """Return a number of an SI unit in the unit that is shown."""
        unit = self.unit(si)
        return number * unit.factor + unit.offset

    def shown(self, number: object, si: str | None = None, digits: int = _DIGITS) -> str:
        """Return a number with its unit, and a dash where there is none."""
        if isinstance(number, bool) or not isinstance(number, int | float):
            return _NO_NUMBER if number is None else str(number)
        return f"{self.number(number, si, digits)} {self.unit(si).name}".rstrip()

    def sentence(self, text: str) -> str:
        """Return a sentence whose quantities in SI are in the units that are shown, each on one line with its unit."""
        return _IN_TEXT.sub(self._quantity, text)

    def _quantity(self, found: re.Match[str]) -> str:
        *numbers, si = found.groups()
        shown = " to ".join(self._like(number, si) for number in numbers if number)
        return f"{shown}\N{NO-BREAK SPACE}{self.unit(si).name}"

    def _like(self, number: str, si: str) -> str:
        """Return a number of a sentence in the unit that is shown, with as many digits."""
        digits = max(len(number.replace(".", "").lstrip("-0")), 1)
        return plain(self.value(float(number), si), digits) if si in self.instead else number

    def number(self, number: object, si: str | None = None, digits: int = _DIGITS) -> str:
        """Return a number without its unit."""
        if isinstance(number, bool) or not isinstance(number, int | float):
            return _NO_NUMBER if number is None else str(number)
        if isinstance(number, int) and si in {None, "1"}:
            return str(number)
        return plain(self.value(number, si), digits)


_SPELLED = {"1": "", "degC": "°C", "deg": "°", "N m2": "N·m²", "N m": "N·m", "kg/m3": "kg/m³", "m2": "m²"} | {
    "kg m": "kg·m",
    "kg m2": "kg·m²",
    "N m s": "N·m·s",
}
SI = Units("si")
FEET = Units(
    "feet",
    {
        "m": Unit("ft", 1 / 0.3048),
        "m2": Unit("in²", 1 / 0.0254**2, 0.0, "in2"),
        "N": Unit("lbf", 1 / 4.4482216152605),
        "N/m": Unit("lbf/ft", 0.3048 / 4.4482216152605),
        "kg": Unit("lb", 1 / 0.45359237),
        "kg/m": Unit("lb/ft", 0.3048 / 0.45359237),
        "kg/m3": Unit("lb/ft³", 0.3048**3 / 0.45359237, 0.0, "lb/ft3"),
        "kg m": Unit("lb·ft", 1 / (0.45359237 * 0.3048), 0.0, "lb*ft"),
        "kg m2": Unit("lb·ft²", 1 / (0.45359237 * 0.3048**2), 0.0, "lb*ft2"),
        "N m2": Unit("lbf·ft²", 1 / (4.4482216152605 * 0.3048**2), 0.0, "lbf*ft2"),
        "N m s": Unit("lbf·ft·s", 1 / (4.4482216152605 * 0.3048), 0.0, "lbf*ft*s"),
        "m/s": Unit("mph", 1 / 0.44704),
        "Pa": Unit("psi", 0.0254**2 / 4.4482216152605),
        "degC": Unit("°F", 1.8, 32.0, "degF"),
        "mm": Unit("in", 1 / 25.4),
    },
)
BY_NAME: Mapping[str, Units] = {units.name: units for units in (SI, FEET)}


def plain(number: float, digits: int = _DIGITS) -> str:
    """Return a number rounded to so many digits, written out unless it is very large or very small."""
    if number == 0.0:
        return "0"
    number = float(f"{number:.{digits - 1}e}")  # rounding may change the power of ten
    power = floor(log10(abs(number)))
    if not -_FROM_TEN_THOUSAND <= power <= _FROM_TEN_THOUSAND + 3:
        return f"{number:.{digits - 1}e}"
    places = max(0, digits - 1 - power)
    return f"{number:,.{places}f}".replace(",", "\N{NARROW NO-BREAK SPACE}")
