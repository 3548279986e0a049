"""The sliders of a line: which of its values can be moved, from where to where, in the units of the reader."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isclose

from app.pages.measures import Units, plain
from app.pages.what_if.documents import Line, Place, number_at, pendulum
from app.pages.wording import words

_PERCENT = 100.0
_TENSIONS: Sequence[tuple[Place, str]] = (
    (("span", "everyday", "share_of_rated_strength"), "1"),
    (("span", "everyday", "horizontal_tension_n"), "N"),
    (("span", "everyday", "sag_m"), "m"),
    (("span", "horizontal_tension_n"), "N"),
    (("span", "catenary_parameter_m"), "m"),
    (("span", "sag_m"), "m"),
)
_THICKNESS: Place = ("ice", "accretion", "thickness_m")
_MASS: Place = ("ice", "accretion", "mass_kg_per_m")
_LEAST_WIND = 20.0  # [m/s]: up to where the wind may be moved at least
_LEAST_ICE = 0.04  # [m]
_HEAVIEST = 80.0  # [kg], at least, for a pendulum
_USUAL_ARM = 0.5  # [m]


@dataclass(frozen=True, slots=True)
class Slider:
    """A value that can be moved: its name, its place in the line, and what is shown for one of its SI unit.

    low, high and value are as they are shown; place is None where the value is no field by itself.
    """

    name: str
    label: str
    unit: str
    low: float
    high: float
    value: float
    factor: float
    place: Place | None = None

    @property
    def text(self) -> str:
        """Return the value as the control holds it."""
        return f"{self.value:.8g}"

    @property
    def shown(self) -> str:
        """Return the value with its unit, for people."""
        return f"{plain(self.value)} {self.unit}".rstrip()

    def moved_to(self, text: str | None) -> float | None:
        """Return the SI value that a control says, None where it stands as it stood, or says no number in bounds."""
        try:
            value = float(text) if text else self.value
        except ValueError:
            return None
        if not self.low <= value <= self.high or isclose(value, float(self.text), rel_tol=1e-6, abs_tol=1e-12):
            return None
        return float(f"{value / self.factor:.5g}")


def sliders(line: Line, explicit: Line, speeds: Sequence[float], units: Units) -> dict[str, Slider]:
    """Return the sliders of a line by their names.

    Parameters
    ----------
    line, explicit : mapping
        The line as it was said, and the explicit line that follows from it.
    speeds : sequence of float
        Wind speeds that the analysis names [m/s].
    units : Units
        Those of the reader.
    """
    made = [_wind(line, speeds, units), _tension(line, explicit, units)]
    if not line.get("section"):  # its spans say the length once more
        length = number_at(line, ("span", "length_m"), "m") or 1.0
        made.append(_slider("span", (0.6 * length, 1.5 * length, length), ("m", 1.0), units, ("span", "length_m")))
    made += [*_ice(line, units), *_damping(line, explicit, units), *_pendulum(line, units)]
    return {slider.name: slider for slider in made if slider is not None}


def _slider(
    name: str, reach: tuple[float, float, float], unit: tuple[str, float], units: Units, place: Place | None = None
) -> Slider:
    """Return a slider from its ends and its value in SI, and its unit with a factor before it."""
    si, by = unit
    shown = "%" if (si, by) == ("1", _PERCENT) else units.unit(si).name
    factor = by * units.unit(si).factor
    low, high, value = (end * factor for end in reach)
    label = getattr(words().what_if.sliders, name)
    # The ends are round, but the value stays what it is and lies between them.
    return Slider(name, label, shown, min(_round(low), value), max(_round(high), value), value, factor, place)


def _round(value: float) -> float:
    return float(f"{value:.2g}")


def _wind(line: Line, speeds: Sequence[float], units: Units) -> Slider:
    top = max(speeds, default=_LEAST_WIND)
    value = number_at(line, ("design_wind_m_per_s",), "m/s") or top
    return _slider("wind", (1.0, max(_LEAST_WIND, 1.5 * top, value), value), ("m/s", 1.0), units)


def _tension(line: Line, explicit: Line, units: Units) -> Slider | None:
    """Return the slider of the measure of tension in which the line is said; the iced tension where none is said."""
    for document in (line, explicit):
        for place, si in _TENSIONS:
            value = number_at(document, place, si)
            if value is not None:
                name = "_".join(("tension", *map(str, place[1:])))
                by = _PERCENT if si == "1" else 1.0
                return _slider(name, (0.6 * value, 1.6 * value, value), (si, by), units, place)
    return None


def _ice(line: Line, units: Units) -> Sequence[Slider]:
    thickness = number_at(line, _THICKNESS, "m")
    if thickness is not None:
        reach = (0.001, max(_LEAST_ICE, 2.0 * thickness), thickness)
        return [_slider("ice", reach, ("mm", 1000.0), units, _THICKNESS)]
    mass = number_at(line, _MASS, "kg/m")
    return [] if mass is None else [_slider("ice_mass", (0.1 * mass, 3.0 * mass, mass), ("kg/m", 1.0), units, _MASS)]


def _damping(line: Line, explicit: Line, units: Units) -> Sequence[Slider]:
    made = []
    for name in ("vertical_ratio", "torsional_ratio"):
        place: Place = ("damping", name)
        value = number_at(line, place, "1")
        value = number_at(explicit, place, "1") if value is None else value
        if value is not None:
            reach = (0.0, 5.0 * value or 0.01, value)
            made.append(_slider(f"damping_{name}", reach, ("1", _PERCENT), units, place))
    return made


def _pendulum(line: Line, units: Units) -> Sequence[Slider]:
    """Return mass, place along the span, and arm of the first pendulum; without one its mass is 0."""
    number, length = pendulum(line), number_at(line, ("span", "length_m"), "m") or 1.0

    def of(name: str, unit: str) -> float | None:
        return None if number is None else number_at(line, ("devices", number, name), unit)

    mass, position, arm = of("mass_kg", "kg") or 0.0, of("position_m", "m"), of("arm_m", "m") or _USUAL_ARM
    share = 0.5 if position is None else position / length
    return [
        _slider("pendulum_mass", (0.0, max(_HEAVIEST, 2.0 * mass), mass), ("kg", 1.0), units),
        _slider("pendulum_place", (0.0, 1.0, share), ("1", _PERCENT), units),
        _slider("pendulum_arm", (0.1, max(2.0, arm), arm), ("m", 1.0), units),
    ]


def moves(found: Mapping[str, Slider], fields: Mapping[str, str]) -> dict[str, float]:
    """Return the SI values of the sliders that a form has moved."""
    said = {name: slider.moved_to(fields.get(name)) for name, slider in found.items()}
    return {name: value for name, value in said.items() if value is not None}
