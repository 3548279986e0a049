"""Verdicts on real results, and on results with one thing changed."""

from dataclasses import replace
from functools import cache

import pytest

from engine.outcome import Outcome, Stability
from engine.report.verdict import verdict
from engine.result import Result, VerdictRow
from engine.spec import AerodynamicModel, Analysis, Check, Line, LongitudinalInertia, Model, Phase, Stretching
from tests.builders import only, run, source_line

ASKED = replace(
    only(Model.HYBRID, loops=(1,), wind_speeds=(4.0, 10.0)),
    aerodynamic_model=AerodynamicModel.RELATIVE_WIND,
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)


def twin() -> Line:
    """Return the source's twin bundle with coefficients at rest."""
    line = source_line(2)
    return replace(line, ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))))


@cache
def analysed(analysis: Analysis = ASKED) -> Result:
    return run(twin(), analysis)


def judged(result: Result, analysis: Analysis = ASKED) -> VerdictRow:
    return verdict(result, twin(), analysis)


def test_a_result_holds_its_verdict() -> None:
    (row,) = analysed().verdict
    assert row == judged(analysed())


def test_the_twin_gallops_as_theory_section_16_says() -> None:
    row = judged(analysed())
    assert (row.gallops, row.worst_wind_m_per_s, row.worst_loops, row.trust) == ("yes", 10.0, 1, "plausible")
    assert row.vertical_peak_to_peak_m == pytest.approx(2.0 * 0.5641, rel=0.01)
    assert row.horizontal_peak_to_peak_m == pytest.approx(2.0 * 0.0837, rel=0.01)
    assert row.tension_range_n == pytest.approx(32_057.0 - 28_583.0, rel=0.02)  # there at the ends of the span
    assert row.onset_m_per_s == analysed().critical_wind_speeds[0].wind_speed_m_per_s
    assert row.sentence == f"Gallops from {row.onset_m_per_s:.1f} m/s; at 10 m/s in one loop, 1.13 m peak to peak."
    assert row.ellipse_peak_to_peak_m is None  # d ln(8 S / 500 d) is negative for so small a sag


def test_the_design_ellipse_is_that_of_bundles() -> None:
    line = twin()
    slack = replace(line, span=replace(line.span, length=350.0, horizontal_tension=None, sag=20.65 * 0.3048))
    thin = replace(slack, conductor=replace(line.conductor, diameter=28.1432e-3))
    found = replace(analysed(), static=replace(analysed().static, sag_m=20.65 * 0.3048))
    ellipse = verdict(found, thin, ASKED).ellipse_peak_to_peak_m
    assert ellipse == pytest.approx(20.0 * 0.3048, rel=0.02)  # the example of the design guide, in feet


def test_direct_integration_that_agrees_makes_it_checked() -> None:
    asked = replace(ASKED, check=Check.DIRECT)
    cycles = tuple(replace(row, direct_difference=0.002) for row in analysed().limit_cycles)
    found = replace(analysed(), limit_cycles=cycles)
    assert judged(found, asked).trust == "checked"
    apart = replace(found, limit_cycles=tuple(replace(row, direct_difference=0.02) for row in cycles))
    assert judged(apart, asked).trust == "plausible"
    assert judged(found).trust == "plausible"


def test_rest_at_all_wind_speeds_is_a_no_that_names_the_onset_above_them() -> None:
    calm = replace(ASKED, wind_speeds=(1.0,))
    row = judged(analysed(calm), calm)
    assert (row.gallops, row.worst_wind_m_per_s, row.vertical_peak_to_peak_m) == ("no", None, None)
    assert row.onset_m_per_s is not None
    onset = f"{row.onset_m_per_s:.1f}"
    assert row.sentence == (
        f"Stays at rest at the wind speeds asked for, up to 1 m/s; it would lose stability at {onset} m/s."
    )


def test_without_wind_speeds_only_an_onset_decides() -> None:
    asked = replace(ASKED, wind_speeds=())
    row = judged(analysed(asked), asked)
    assert row.gallops == "yes"
    assert row.sentence.endswith("how far was not found. No wind speed was asked for.")
    undecided = judged(replace(analysed(asked), critical_wind_speeds=()), asked)
    assert (undecided.gallops, undecided.onset_m_per_s) == ("undecided", None)
    assert undecided.sentence == "Not decided. No wind speed was asked for."


@pytest.mark.parametrize(
    ("outcome", "gallops", "trust"),
    [
        (Outcome.NO_CONVERGENCE, "undecided", "plausible"),
        (Outcome.NO_BOUNDED_MOTION, "yes", "beyond_data"),
        (Outcome.STATICALLY_UNSTABLE, "undecided", "beyond_data"),
    ],
)
def test_what_is_not_known_is_never_a_no(outcome: Outcome, gallops: str, trust: str) -> None:
    cycle = next(row for row in analysed().limit_cycles if row.kind == "periodic")
    lost = replace(cycle, vertical_m=None, horizontal_m=None, stability=Stability.UNKNOWN, outcome=outcome)
    row = judged(replace(analysed(), limit_cycles=(lost,), critical_wind_speeds=()))
    assert (row.gallops, row.trust, row.vertical_peak_to_peak_m) == (gallops, trust, None)
    assert outcome.sentence[1:] in row.sentence
    beside_rest = judged(replace(analysed(), limit_cycles=(analysed().limit_cycles[0], lost), critical_wind_speeds=()))
    assert beside_rest.gallops == gallops


def test_a_motion_beyond_the_data_is_not_to_be_relied_on() -> None:
    cycles = tuple(replace(row, outcome=Outcome.BEYOND_DATA) for row in analysed().limit_cycles)
    row = judged(replace(analysed(), limit_cycles=cycles))
    assert (row.gallops, row.trust) == ("yes", "beyond_data")
    assert "The size is not to be relied on: the motion is larger than the input can vouch for" in row.sentence


def test_a_slack_conductor_is_said_and_has_no_range_of_tension() -> None:
    tensions = tuple(
        replace(row, smallest_at_support_n=None, largest_at_support_n=None, outcome=Outcome.SLACK)
        for row in analysed().tensions
    )
    row = judged(replace(analysed(), tensions=tensions))
    assert (row.tension_range_n, row.trust) == (None, "beyond_data")
    assert row.sentence.endswith(Outcome.SLACK.sentence)


def test_a_motion_below_the_onset_is_named() -> None:
    onset = replace(analysed().critical_wind_speeds[0], wind_speed_m_per_s=7.0)
    row = judged(replace(analysed(), critical_wind_speeds=(onset,)))
    assert row.sentence.endswith("Once started, it goes on from 4 m/s.")
    alone = judged(replace(analysed(), critical_wind_speeds=()))
    assert alone.gallops == "yes"
    assert alone.sentence.startswith(
        "Can gallop from 4 m/s on if something starts it, though the span at rest is stable"
    )


def test_phases_that_may_touch_are_said() -> None:
    line = replace(twin(), phases=(Phase("top", y=0.5, z=0.0),))
    row = run(line, ASKED).verdict[0]
    assert row.clearance_m is not None
    assert row.clearance_m < 0.0
    assert "m peak to peak; may touch the next phase." in row.sentence


@pytest.mark.parametrize("speed", [4.0, 10.0, 7.0])
def test_the_sentence_is_put_at_the_design_wind_if_it_was_asked_for(speed: float) -> None:
    row = verdict(analysed(), replace(twin(), design_wind=speed), ASKED)
    assert row == replace(judged(analysed()), sentence=row.sentence)
    sizes = {
        cycle.wind_speed_m_per_s: 2.0 * (cycle.vertical_m or 0.0)
        for cycle in analysed().limit_cycles
        if cycle.stability is Stability.STABLE and cycle.kind == "periodic"
    }
    onset = f"Gallops from {row.onset_m_per_s:.1f} m/s; "
    most = f"at 10 m/s in one loop, {sizes[10.0]:.2f} m peak to peak."
    at_design = f"at 4 m/s in one loop, {sizes[4.0]:.2f} m peak to peak; most "
    assert row.sentence == onset + (at_design if speed == 4.0 else "") + most


def test_rest_at_the_design_wind_is_said_beside_the_worst_motion() -> None:
    asked = replace(ASKED, wind_speeds=(1.0, 10.0))
    row = verdict(analysed(asked), replace(twin(), design_wind=1.0), asked)
    assert (
        "; at the design wind of 1 m/s no stable motion was found; most at 10 m/s in one loop, 1.13 m" in row.sentence
    )


def test_distances_at_the_design_wind_and_at_the_worst_one_stand_behind_their_motions() -> None:
    phases = (Phase("top", 2.0, 0.0, required_clearance=1.0),)
    line = replace(twin(), phases=phases, design_wind=4.0)
    found = run(line, ASKED)
    near = {wind: [row for row in found.clearances if row.wind_speed_m_per_s == wind] for wind in (4.0, 10.0)}
    least = {
        wind: min(row.distance_m or 9.0 for row in rows if row.stability == "stable") for wind, rows in near.items()
    }
    before, after = found.verdict[0].sentence.split("; most at 10 m/s")
    assert least[10.0] < 1.0 < least[4.0]
    assert before.endswith(f"keeps {least[4.0]:.1f} m to the next phase")
    assert f"comes within {least[10.0]:.1f} m of the next phase, nearer than required" in after


@pytest.mark.parametrize("share", [None, 0.4, 1.3])
def test_the_share_of_the_rated_strength_is_that_of_the_worst_motion(share: float | None) -> None:
    largest = next(row.largest_at_support_n for row in analysed().tensions if row.wind_speed_m_per_s == 10.0)
    assert largest is not None
    strength = None if share is None else largest / share
    line = replace(twin(), conductor=replace(twin().conductor, rated_strength=strength))
    (row,) = run(line, ASKED).verdict
    assert row.largest_share_of_rated_strength == (None if share is None else pytest.approx(share, rel=1e-6))
    assert ("The tension reaches 130 % of the rated strength." in row.sentence.replace("%", " %")) is (share == 1.3)
