"""Change of state against a published table and mechaphlowers."""

import math
from collections.abc import Iterator

from benchmarks import mechaphlowers
from benchmarks.validation.common import percent, table
from engine.known.change_of_state import HungSpan, LoadState, change_of_state
from engine.known.ice_sections import Accretion, BareConductor, Shape, ice_section
from engine.spec import GRAVITY

POUND, FOOT, INCH = 4.4482216152605, 0.3048, 0.0254
EXPANSION, DIAMETER, MASS, AREA = 18.82e-6, 0.02814, 1.6281, 468.64e-6
MODULUS = 69.64e9
STRUNG = 15.0  # degrees Celsius
ICE_DENSITY = 900.0
SPANS = ((300.0, 0.0, 28e3), (300.0, 60.0, 28e3), (500.0, -90.0, 32e3))
SECTION, STRING = (280.0, 300.0, 330.0), (4.5, 250.0)
WEATHERS = ((15.0, 0.0, 0.012), (-20.0, 0.0, 0.0), (50.0, 0.0, 0.0), (-5.0, 0.0, 0.012), (-5.0, 200.0, 0.012))


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Change of state\n"
    yield (
        "Drake on a level span of 700 ft, NESC heavy, final: horizontal tension from 5,429 lb at 60 F, bare, against "
        "the published table, with the modulus of the catalogue's row and with the one that other tables give. NESC "
        "adds 0.3 lb/ft to the resultant of ice and wind. Creep, and aluminium that goes slack before steel, are left "
        "out.\n"
    )
    head = ["state", "published lb", "69.64 GPa", "difference %", "74 GPa", "difference %"]
    yield table(head, list(_published_rows()))
    yield (
        "\nDrake from its tension at 15 degrees Celsius, bare, to other states, against mechaphlowers (elastic "
        "catenaries between dead ends; it takes the mean tension for the strain and adds thermal strain):\n"
    )
    head = ["span m", "level difference m", "degrees C", "wind Pa", "ice m", "H N", "mechaphlowers", "difference %"]
    yield table(head, [row for span in SPANS for row in _span_rows(*span)])
    yield (
        "\nThe ruling span of a section of 280, 300 and 330 m, 28 kN, against mechaphlowers, whose strings (4.5 m, "
        "250 kg) lean until they are in balance; its smallest and largest tension:\n"
    )
    yield table(["degrees C", "wind Pa", "ice m", "H N", "mechaphlowers", "largest difference %"], _section_rows())


def _ice_weight(diameter: float, thickness: float, density: float) -> float:
    """Return the weight of a uniform layer [N/m]."""
    if thickness == 0.0:
        return 0.0
    bare = BareConductor(diameter, 1.0, 1.0)
    return GRAVITY * ice_section(bare, Accretion(Shape.UNIFORM, thickness, density=density)).ice_mass


def _published_rows() -> Iterator[list[object]]:
    bare, ice = 1.094 * POUND / FOOT, _ice_weight(1.108 * INCH, 0.5 * INCH, 57.0 * 0.45359237 / FOOT**3)
    wind = 4.0 * POUND / FOOT**2 * (1.108 + 2 * 0.5) * INCH
    everyday = LoadState((60.0 - 32.0) / 1.8, bare)
    states = {
        "32 F, half an inch of ice": (LoadState(0.0, bare + ice), 9224.0),
        "0 F, ice and 4 lb/ft2": (LoadState(-32.0 / 1.8, bare + ice, wind, constant=0.3 * POUND / FOOT), 11318.0),
    }
    for name, (state, published) in states.items():
        cells: list[object] = [name, f"{published:.0f}"]
        for modulus in (MODULUS, 74e9):
            span = HungSpan(700.0 * FOOT, AREA * modulus, EXPANSION)
            found = change_of_state(span, 5429.0 * POUND, everyday, state).horizontal_tension / POUND
            cells += [f"{found:.0f}", percent(found, published)]
        yield cells


def _tension(span: HungSpan, strung: float, weather: tuple[float, float, float]) -> float:
    temperature, pressure, thickness = weather
    weight = GRAVITY * MASS
    ice, drag = _ice_weight(DIAMETER, thickness, ICE_DENSITY), pressure * (DIAMETER + 2.0 * thickness)
    wanted = LoadState(temperature, weight + ice, drag)
    return change_of_state(span, strung, LoadState(STRUNG, weight), wanted).horizontal_tension


def _span_rows(length: float, rise: float, strung: float) -> Iterator[list[object]]:
    cable = mechaphlowers.HungCable(DIAMETER, AREA * MODULUS, MASS, length, strung, rise, EXPANSION, STRUNG)
    for weather in WEATHERS:
        found = _tension(HungSpan(length, AREA * MODULUS, EXPANSION, rise), strung, weather)
        expected = mechaphlowers.horizontal_tension(cable, mechaphlowers.Weather(*weather, GRAVITY * ICE_DENSITY))
        cells = [f"{length:g}", f"{rise:g}", *(f"{value:g}" for value in weather)]
        yield [*cells, f"{found:.0f}", f"{expected:.0f}", percent(found, expected)]


def _section_rows() -> list[list[object]]:
    strung = SPANS[0][2]
    ruling = math.sqrt(sum(length**3 for length in SECTION) / sum(SECTION))
    span = HungSpan(SECTION[1], AREA * MODULUS, EXPANSION, ruling_span=ruling)
    cable = mechaphlowers.HungCable(DIAMETER, AREA * MODULUS, MASS, SECTION[1], strung, 0.0, EXPANSION, STRUNG)
    rows: list[list[object]] = []
    for weather in WEATHERS:
        found = _tension(span, strung, weather)
        peer = mechaphlowers.Weather(*weather, GRAVITY * ICE_DENSITY)
        expected = mechaphlowers.section_tensions(cable, SECTION, STRING, peer)
        worst = max(expected, key=lambda value: abs(found / value - 1.0))
        both = f"{min(expected):.0f} to {max(expected):.0f}"
        rows.append([*(f"{value:g}" for value in weather), f"{found:.0f}", both, percent(found, worst)])
    return rows
