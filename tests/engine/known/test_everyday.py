"""The iced span from its everyday state."""

from collections.abc import Mapping
from dataclasses import replace

import pytest

from engine.known.bare_conductor import bare_conductor
from engine.known.change_of_state import HungSpan, LoadState, change_of_state, hung_state
from engine.known.description import ConductorData, EverydayState, KnownConductor, KnownSpan
from engine.known.everyday import IcedSpan, iced_span
from engine.known.provenance import Origin
from engine.outcome import InvalidSpec
from engine.spec import GRAVITY, Support, Supports
from tests.engine.known.known_lines import DRAKE, SPARSE

VALUES = bare_conductor(KnownConductor(row=DRAKE), {}, bare=True)
STRENGTH, BARE_MASS, ICED_MASS = 140120.0, 1.6281, 2.3
SPAN = KnownSpan(300.0, EverydayState(0.2, temperature=15.0), -5.0, 305.0)
SUPPORTS = Supports()
DEAD_ENDS = Supports(left=Support(dead_end=True), right=Support(dead_end=True))


def hang(
    span: KnownSpan, supports: Supports = SUPPORTS, mass: float = ICED_MASS, chosen: Mapping[str, float] | None = None
) -> IcedSpan:
    return iced_span(replace(SPARSE, span=span, supports=supports), span, VALUES, mass, chosen or {})


def test_a_share_of_the_rated_strength_becomes_the_iced_tension() -> None:
    found = hang(SPAN)
    hung = HungSpan(300.0, 468.64e-6 * 69.64e9, 18.82e-6, ruling_span=305.0)
    usual, iced = LoadState(15.0, GRAVITY * BARE_MASS), LoadState(-5.0, GRAVITY * ICED_MASS)
    expected = change_of_state(hung, 0.2 * STRENGTH, usual, iced)
    assert found.iced == expected
    assert found.everyday.horizontal_tension == pytest.approx(0.2 * STRENGTH)
    assert found.span.horizontal_tension == expected.horizontal_tension
    assert found.rows["span.horizontal_tension"] == expected.horizontal_tension


def test_all_measures_of_the_everyday_state_agree() -> None:
    first = hang(SPAN)
    for measure in (
        EverydayState(horizontal_tension=0.2 * STRENGTH, temperature=15.0),
        EverydayState(sag=first.everyday.sag, temperature=15.0),
    ):
        other = hang(replace(SPAN, everyday=measure))
        assert other.span.horizontal_tension == pytest.approx(first.span.horizontal_tension, rel=1e-9)


def test_wind_on_the_everyday_span_counts_for_its_measure() -> None:
    windy = hang(replace(SPAN, everyday=EverydayState(0.2, temperature=15.0, wind_pressure=400.0)))
    usual = LoadState(15.0, GRAVITY * BARE_MASS, 400.0 * 0.02814)
    hung = HungSpan(300.0, 468.64e-6 * 69.64e9, 18.82e-6, ruling_span=305.0)
    assert windy.everyday == hung_state(hung, 0.2 * STRENGTH, usual)
    assert windy.iced.horizontal_tension < hang(SPAN).iced.horizontal_tension


def test_what_is_not_said_of_the_span_is_assumed() -> None:
    found = hang(KnownSpan(300.0))
    ranges = {row.path: (row.lowest, row.value, row.highest) for row in found.rows.rows if row.origin is Origin.ASSUMED}
    assert ranges == {
        "span.everyday.temperature": (5.0, 15.0, 25.0),
        "span.temperature": (-10.0, -3.0, 0.0),
        "span.ruling_span": (240.0, pytest.approx(300.0), 375.0),
        "span.everyday.share_of_rated_strength": (0.15, 0.2, 0.25),
    }
    tight = hang(KnownSpan(300.0), chosen={"span.everyday.share_of_rated_strength": 0.25, "span.temperature": -10.0})
    said = replace(SPAN, everyday=EverydayState(0.25, temperature=15.0), temperature=-10.0, ruling_span=300.0)
    assert tight.span.horizontal_tension == pytest.approx(hang(said).span.horizontal_tension, rel=1e-9)


def test_known_neighbours_estimate_the_ruling_span_and_dead_ends_need_none() -> None:
    neighbours = Supports(left=Support(adjacent_span=200.0), right=Support(adjacent_span=400.0))
    ruling = hang(replace(SPAN, ruling_span=None), neighbours).rows["span.ruling_span"]
    assert ruling == pytest.approx(((200.0**3 + 300.0**3 + 400.0**3) / 900.0) ** 0.5)
    alone = hang(replace(SPAN, ruling_span=None, level_difference=40.0), DEAD_ENDS)
    assert "span.ruling_span" not in alone.rows
    assert alone.span.level_difference == 40.0


@pytest.mark.parametrize(
    ("span", "mass", "fault"),
    [
        (
            replace(SPAN, everyday=EverydayState(0.9, temperature=15.0)),
            4.5,
            r"span\.everyday\.share_of_rated_strength must leave the tension below the rated strength \(140120 N\): "
            r"it would be 1\d{5} N under ice at -5 degrees Celsius, got 0\.9",
        ),
        (
            replace(SPAN, temperature=268.0 + 40.0),
            2.3,
            r"span\.temperature must lie between .* looks like kelvin, got 308",
        ),
        (
            replace(SPAN, everyday=EverydayState(0.2, temperature=590.0)),
            2.3,
            r"span\.everyday\.temperature must lie between -100 and 300 degrees Celsius, got 590",
        ),
        (
            replace(SPAN, everyday=EverydayState(sag=400.0, temperature=15.0)),
            2.3,
            r"span\.everyday\.sag must be smaller than the span's length \(300\.0\), got 400",
        ),
    ],
)
def test_a_state_that_cannot_be_is_named(span: KnownSpan, mass: float, fault: str) -> None:
    with pytest.raises(InvalidSpec, match=fault):
        hang(span, mass=mass)


def test_a_share_needs_the_rated_strength() -> None:
    values = bare_conductor(KnownConductor(ConductorData(diameter=0.028, bare_mass=1.6)), {}, bare=True)
    with pytest.raises(
        InvalidSpec, match=r"conductor\.rated_strength must be given where the everyday tension is a share"
    ):
        iced_span(SPARSE, SPAN, values, 2.3, {})
    known = replace(SPAN, everyday=EverydayState(horizontal_tension=150e3, temperature=15.0))
    assert iced_span(SPARSE, known, values, 2.3, {}).iced.largest_tension > 150e3
