"""Change of state: the tension of a span at another temperature and under another load. Theory section 15.

The length of the conductor without tension and at one temperature stays. It is that of an elastic catenary, whose
tension varies along the span, and grows with temperature. Where a ruling span is given, the supports along the section
are taken to equalize the tension, and that span, level, has the section's change of state.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from engine.arrays import FloatArray
from engine.mechanics.blow_out import plane_extent
from engine.mechanics.catenary import catenary_of_sag, chord_sag, low_point, unstressed_length
from engine.outcome import Fault, require
from engine.spec.rules import finite, not_negative, positive

COLDEST, HOTTEST = -100.0, 300.0  # degrees Celsius; outside, a temperature is in another unit
STEEPEST = 3.0  # half the span over the catenary parameter: the conductor is three times as long as the span
MOST_EXPANSION = 1e-4  # 1/K, several times that of any conductor
TOLERANCE = 1e-13  # relative, of the logarithm of the tension
NEAR = 0.01  # relative difference in tension of parabola and catenary, where the solution is sought first
PARABOLA_STEPS = 12


@dataclass(frozen=True, slots=True)
class HungSpan:
    """A span of bare or iced conductor: what a change of state leaves as it is.

    length: horizontal distance of the supports [m]; level_difference: of the right support above the left one [m];
    ruling_span: of the section [m], None where the span stands between dead ends; rigidity EA [N]; thermal_expansion
    [1/K].
    """

    length: float
    rigidity: float
    thermal_expansion: float
    level_difference: float = 0.0
    ruling_span: float | None = None

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            positive("span.length", self.length),
            positive("conductor.axial_rigidity", self.rigidity),
            not_negative("conductor.thermal_expansion", self.thermal_expansion),
            Fault("conductor.thermal_expansion", self.thermal_expansion, "must be per kelvin, at most 1e-4")
            if self.thermal_expansion > MOST_EXPANSION
            else None,
            finite("span.level_difference", self.level_difference),
            positive("span.ruling_span", self.ruling_span),
        )


@dataclass(frozen=True, slots=True)
class LoadState:
    """Load and temperature of a sub-conductor.

    temperature [degrees Celsius]; weight: of conductor and ice per length [N/m]; drag: horizontal load of the wind per
    length [N/m]; constant: what a code adds to the resultant of both [N/m].
    """

    temperature: float
    weight: float
    drag: float = 0.0
    constant: float = 0.0

    def __post_init__(self) -> None:
        """Check the rules of every field."""
        require(
            _temperature_fault(self.temperature),
            positive("weight", self.weight),
            not_negative("drag", self.drag),
            not_negative("constant", self.constant),
        )

    @property
    def resultant(self) -> float:
        """The load per length in the plane of the sag [N/m]."""
        return math.hypot(self.weight, self.drag) + self.constant

    @property
    def tilt(self) -> float:
        """The angle of the plane of the sag from the vertical [rad]."""
        return math.atan2(self.drag, self.weight)


@dataclass(frozen=True, slots=True)
class HungState:
    """A span in a load state: horizontal_tension along X [N], largest_tension, at the higher support [N], sag from the
    chord in its plane [m], unstressed_length of the conductor at the state's temperature [m].
    """

    horizontal_tension: float
    largest_tension: float
    sag: float
    unstressed_length: float


def hung_state(span: HungSpan, tension: float, load: LoadState) -> HungState:
    """Return the state of a span with a horizontal tension along X [N] under a load."""
    loaded = _Loaded.of(span, (span.length, span.level_difference), load)
    in_plane = tension * loaded.incline
    catenary = in_plane / load.resultant
    curve = _arrays(catenary, loaded.extent, loaded.rise)
    low = float(low_point(*curve)[0])
    steepest = max(abs(low), abs(loaded.extent - low))
    return HungState(
        horizontal_tension=tension,
        largest_tension=in_plane * math.cosh(steepest / catenary),
        sag=float(chord_sag(*curve)[0]),
        unstressed_length=loaded.unstressed(tension),
    )


def tension_of_sag(span: HungSpan, sag: float, load: LoadState) -> float:
    """Return the horizontal tension along X [N] at which a span hangs with a sag from its chord, in its plane [m]."""
    require(positive("sag", sag))
    extent, rise = (float(part[0]) for part in plane_extent(*_arrays(span.length, span.level_difference, load.tilt)))
    return catenary_of_sag(sag, extent, rise) * load.resultant * span.length / extent


def change_of_state(span: HungSpan, tension: float, given: LoadState, wanted: LoadState) -> HungState:
    """Return the state of a span in another load state.

    Parameters
    ----------
    span : HungSpan
    tension : float
        Horizontal tension along X in the given state [N].
    given, wanted : LoadState

    Returns
    -------
    HungState
        In the wanted state. The length that a tension leaves without tension falls as it rises, so there is one
        solution at most.

    Raises
    ------
    InvalidSpec
        If the span hangs slacker than any conductor does, in the given or in the wanted state, or no tension has the
        length of the conductor.
    """
    require(positive("tension", tension))
    held = (span.length, span.level_difference) if span.ruling_span is None else (span.ruling_span, 0.0)
    require(_slack_fault(held[0], tension, given))
    strain = span.thermal_expansion * (wanted.temperature - given.temperature)
    target = _Loaded.of(span, held, given).unstressed(tension) * (1.0 + strain)
    loaded = _Loaded.of(span, held, wanted)

    def excess(logarithm: float) -> float:
        return loaded.unstressed(math.exp(logarithm)) - target

    lowest = math.log(0.5 * wanted.resultant * held[0] / STEEPEST)
    # Pulled to this tension, the conductor would be shorter than its stretched chord without any sag.
    highest = math.log(span.rigidity + wanted.resultant * held[0])
    middle = min(max(math.log(loaded.tension_of_parabola(target, tension)), lowest), highest)
    ends = max(lowest, middle - NEAR), min(highest, middle + NEAR)
    if excess(ends[0]) < 0.0 or excess(ends[1]) > 0.0:
        ends = lowest, highest
        if excess(lowest) < 0.0 or excess(highest) > 0.0:
            where = f"{target:.4g} m of conductor cannot span {held[0]:g} m"
            rule = f"has no state at {wanted.temperature:g} degrees Celsius: {where}"
            require(Fault("span.everyday", tension, rule))
    return hung_state(span, math.exp(brentq(excess, *ends, xtol=TOLERANCE, rtol=TOLERANCE)), wanted)


@dataclass(frozen=True, slots=True)
class _Loaded:
    """A conductor between supports under a load: extent along and rise in the plane of its sag [m], incline of that
    plane's tension to the one along X, load per length [N/m], rigidity EA [N].
    """

    extent: float
    rise: float
    incline: float
    load: float
    rigidity: float

    @classmethod
    def of(cls, span: HungSpan, held: tuple[float, float], load: LoadState) -> "_Loaded":
        """Return it between supports (distance, rise) [m]."""
        extent, rise = (float(part[0]) for part in plane_extent(*_arrays(*held, load.tilt)))
        return cls(extent, rise, extent / held[0], load.resultant, span.rigidity)

    def unstressed(self, tension: float) -> float:
        """Return the length without tension [m] at a tension along X [N]."""
        in_plane = tension * self.incline
        return float(unstressed_length(*_arrays(in_plane, self.load, self.rigidity, self.extent, self.rise))[0])

    def tension_of_parabola(self, target: float, start: float) -> float:
        """Return about the tension along X [N] of an unstressed length [m], which a level parabola has."""
        chord = math.hypot(self.extent, self.rise)
        slack, hang = target / chord - 1.0, (self.load * self.extent**2 / chord) ** 2 / 24.0
        tension = start
        for _ in range(PARABOLA_STEPS):  # of Newton's method
            wrong = hang / tension**2 - tension / self.rigidity - slack
            tension = max(tension + wrong / (2.0 * hang / tension**3 + 1.0 / self.rigidity), 0.1 * tension)
        return tension / self.incline


def _slack_fault(length: float, tension: float, load: LoadState) -> Fault | None:
    if 0.5 * length * load.resultant <= STEEPEST * tension:
        return None
    rule = (
        f"must carry {length:g} m of conductor with a weight of {load.resultant:.4g} N/m, which would hang like a chain"
    )
    return Fault("span.everyday", tension, rule)


def _temperature_fault(temperature: float) -> Fault | None:
    if COLDEST <= temperature <= HOTTEST:
        return None
    slip = "; this looks like kelvin" if 173.15 <= temperature <= 573.15 else ""
    rule = f"must lie between {COLDEST:.0f} and {HOTTEST:.0f} degrees Celsius{slip}"
    return Fault("temperature", temperature, rule)


def _arrays(*values: float) -> tuple[FloatArray, ...]:
    return tuple(np.array([value]) for value in values)
