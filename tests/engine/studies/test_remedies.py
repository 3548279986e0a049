"""Remedies against analyses of the lines that they make, and what is never said of them."""

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from itertools import pairwise

import pytest

from engine.known.resolve import resolve, resolve_with_tension, with_tension
from engine.outcome import InvalidSpec
from engine.progress import Progress, driven, finished
from engine.result import RemedyRow, Result
from engine.spec import (
    AddedDevices,
    AddedSpoiler,
    Aerodynamics,
    AirflowSpoiler,
    ChangedTension,
    DetuningPendulum,
    Ice,
    InterphaseSpacer,
    Line,
    Model,
    MovedDevices,
    Phase,
    Remedies,
    Spacer,
    Uncertainty,
)
from engine.studies.judgement import figures, judged
from engine.studies.remedies import Subject, compare
from engine.uncertainty.weighing import Unknowns, intervals
from tests.builders import ICE_AT_40, only, run, source_line, stable_cycles
from tests.engine.known.known_lines import GUIDE
from tests.engine.mirror_images import mirrored

ASKED = only(Model.HYBRID, loops=(2,), wind_speeds=(6.0,))
NO_SAMPLES = Uncertainty(0)
PENDULUM = DetuningPendulum(0.0, 15.0, 0.3)
CALM = Aerodynamics((0.0, 0.0, 0.0), (0.9, 0.0, 0.0), (0.0, 0.0, 0.0))
SPOILER = AirflowSpoiler(0.0, 60.0, CALM)
LIST = (
    AddedDevices(PENDULUM, 2, (31.47, 94.41)),
    AddedDevices(PENDULUM, 3),
    AddedSpoiler(SPOILER),
    ChangedTension(0.8),
    ChangedTension(1.25),
)


def explicit(line: Line) -> Subject:
    """Return a line of which everything is given."""

    def line_of(_: Mapping[str, float]) -> Line:
        return line

    return Subject(line, Unknowns((), line_of), lambda tension, _: with_tension(line, tension))


def rows(line: Line, *tried: object, separation: float | None = None) -> tuple[RemedyRow, ...]:
    remedies = Remedies(tried, separation)  # type: ignore[arg-type]
    return finished(compare(explicit(line), ASKED, remedies, NO_SAMPLES)).remedies


@cache
def of_twin() -> Result:
    return finished(compare(explicit(source_line(2)), ASKED, Remedies(LIST), NO_SAMPLES))


@cache
def of_guide() -> Result:
    """Return the guide's line without and with two remedies, over eight samples."""

    def line_of(chosen: Mapping[str, float]) -> Line:
        return resolve(GUIDE, chosen).line

    known = resolve(GUIDE)
    subject = Subject(
        known.line,
        Unknowns(intervals(known.assumptions), line_of),
        lambda tension, chosen: resolve_with_tension(GUIDE, tension, chosen).line,
    )
    tried = (ChangedTension(1.2), AddedDevices(PENDULUM, 2, (75.0, 225.0)))
    asked = only(Model.HYBRID, loops=(1,), wind_speeds=(8.0,))
    return finished(compare(subject, asked, Remedies(tried), Uncertainty(8, 3)))


def figures_of(row: RemedyRow) -> tuple[float | None, ...]:
    return row.onset_m_per_s, row.motion_peak_to_peak_m, row.static_tension_n


@pytest.mark.parametrize("number", range(len(LIST)))
def test_a_row_is_the_analysis_of_the_changed_line(number: int) -> None:
    line, remedy, row = source_line(2), LIST[number], of_twin().remedies[1 + number]
    if isinstance(remedy, ChangedTension):
        changed = replace(line, span=replace(line.span, horizontal_tension=30_000.0 * (remedy.factor or 0.0)))
    elif isinstance(remedy, AddedDevices):
        places = [float(place) for place in (row.places or "").split()]
        changed = replace(line, devices=tuple(DetuningPendulum(place, 15.0, 0.3) for place in places))
    else:
        middle = float(row.places or "nan")
        changed = replace(line, devices=(replace(SPOILER, start=middle - 30.0, stop=middle + 30.0),))
    seen = run(changed, ASKED)
    own = figures(seen, Model.HYBRID, ASKED)
    size = None if own.size is None or math.isinf(own.size) else 2.0 * own.size
    expected = (own.onset, size, seen.static.horizontal_tension_n)
    assert figures_of(row) == tuple(value if value is None else pytest.approx(value) for value in expected)
    assert row.change == judged(run(line, ASKED), seen, ASKED)
    vertical = max(2.0 * (r.vertical_m or 0.0) for r in stable_cycles(seen, loops=2, wind_speed=6.0))
    assert row.vertical_peak_to_peak_m == pytest.approx(vertical)


def test_the_first_row_is_the_line_as_it_is() -> None:
    result = of_twin()
    first = result.remedies[0]
    assert (first.remedy, first.kind, first.change) == (None, "none", None)
    assert first.onset_m_per_s == result.verdict[0].onset_m_per_s
    assert first.sentence == result.verdict[0].sentence
    assert result.limit_cycles == run(source_line(2), ASKED).limit_cycles


def test_what_is_searched_keeps_the_separation_and_is_never_worse_than_nothing() -> None:
    first, *others = of_twin().remedies
    searched = [row for row in others if row.arrangements is not None]
    assert [row.remedy for row in searched] == [1, 2]
    for row in searched:
        assert row.change in {"better", "no_improvement"}
        if row.places is None:
            assert "No improvement found" in row.sentence
            assert figures_of(row) == figures_of(first)
            continue
        places = [float(place) for place in row.places.split()]
        assert all(right - left >= 125.88 / 20 - 1e-3 for left, right in pairwise(places))
        assert row.onset_m_per_s is not None
        assert row.onset_m_per_s >= 0.99 * (first.onset_m_per_s or 0.0)
        assert (row.motion_peak_to_peak_m or 0.0) <= 1.01 * (first.motion_peak_to_peak_m or 0.0)
    assert searched[0].places is not None


def test_ranks_follow_the_motion_whatever_the_order() -> None:
    ranked = {row.kind: row.rank for row in rows(source_line(2), LIST[4], LIST[0])}
    again = {row.kind: row.rank for row in rows(source_line(2), LIST[0], LIST[4])}
    assert ranked == again
    found = sorted((row for row in of_twin().remedies if row.rank), key=lambda row: row.rank or 0)
    sizes = [row.motion_peak_to_peak_m or 0.0 for row in found]
    assert sizes == sorted(sizes)
    assert len(found) >= 2
    assert all((row.rank is not None) == (row.change == "better") for row in of_twin().remedies)


def test_four_pendulums_at_one_tower_are_judged_as_what_they_are() -> None:
    """The old search bunched them there; given so, they are compared, and counted as no improvement."""
    bunched, mild = rows(
        source_line(2), AddedDevices(PENDULUM, 4, (3.0, 6.0, 10.0, 13.0)), AddedDevices(PENDULUM, 1, (62.94,))
    )[1:]
    assert bunched.places == "3 6 10 13"
    assert bunched.arrangements is None
    assert bunched.change != "better" or (bunched.motion_change or 0.0) <= 0.01
    assert mild.what == "1 detuning pendulum of 15 kg, arm 0.3 m, at 62.94 m"


def test_the_mirrored_line_gets_an_equal_proposal() -> None:
    line = replace(source_line(2), devices=(Spacer(40.0, 30.0, 4.0),))
    one, other = (rows(each, AddedDevices(PENDULUM, 2))[1] for each in (line, mirrored(line)))
    assert one.motion_peak_to_peak_m == pytest.approx(other.motion_peak_to_peak_m, rel=1e-4)
    assert one.change == other.change


def test_devices_move_and_stay_in_order() -> None:
    line = replace(
        source_line(2), devices=(Spacer(30.0, 4.0, 0.3), DetuningPendulum(62.0, 9.0, 0.3), Spacer(90.0, 5.0, 0.3))
    )
    moved = MovedDevices(Spacer, (100.0, 20.0)).on(line, (100.0, 20.0))
    assert moved.devices == (line.devices[1], Spacer(20.0, 4.0, 0.3), Spacer(100.0, 5.0, 0.3))
    (row,) = rows(line, MovedDevices(Spacer, (20.0, 100.0)))[1:]
    own = figures(run(moved, ASKED), Model.HYBRID, ASKED)
    assert row.onset_m_per_s == pytest.approx(own.onset, rel=1e-9)


def test_a_line_without_a_static_state_is_never_improved() -> None:
    line = source_line(1)
    line = replace(line, span=replace(line.span, length=400.0), ice=Ice(ICE_AT_40, 4e-3, 0.0))
    asked = only(Model.HYBRID, loops=(1,), wind_speeds=())
    remedies = Remedies((AddedDevices(DetuningPendulum(0.0, 0.1, 0.1), 1, (200.0,)),))
    (row,) = finished(compare(explicit(line), asked, remedies, NO_SAMPLES)).remedies[1:]
    assert (row.change, row.rank, row.onset_m_per_s) == ("undecided", None, None)
    assert "Not decided" in row.sentence


def test_samples_are_those_of_the_line_as_it_is() -> None:
    first, tension, pendulums = of_guide().remedies
    (alone,) = [row for row in of_guide().uncertainty if row.wind_speed_m_per_s is None]
    assert first.probability_gallops == alone.probability
    assert first.onset_p50_m_per_s == alone.onset_p50_m_per_s
    assert first.improves is None
    for row in (tension, pendulums):
        assert row.samples == 8
        shares = (row.improves or 0.0, row.worsens or 0.0, row.undecided_samples or 0.0)
        assert sum(shares) <= 1.0
        assert (row.improves_lowest or 0.0) <= shares[0] <= (row.improves_highest or 0.0)
        assert shares[0] * 8 == int(shares[0] * 8)


def test_another_everyday_tension_is_followed_by_the_change_of_state() -> None:
    _, tension, _ = of_guide().remedies
    before = resolve(GUIDE)
    assert before.everyday is not None
    everyday = replace(GUIDE.span.everyday, share_of_rated_strength=0.24)  # type: ignore[union-attr, type-var]
    stiffer = resolve(replace(GUIDE, span=replace(GUIDE.span, everyday=everyday)))  # type: ignore[arg-type]
    assert tension.static_tension_n == pytest.approx(stiffer.line.span.horizontal_tension, rel=1e-9)
    assert tension.static_tension_n is not None
    assert tension.static_tension_n < 1.2 * (before.line.span.horizontal_tension or 0.0)


def test_a_remedy_that_does_not_fit_is_refused() -> None:
    for remedy, field in (
        (AddedDevices(PENDULUM, 1, (130.0,)), "tried.0.positions"),
        (MovedDevices(Spacer), "tried.0.device"),
        (AddedDevices(PENDULUM, 2, (10.0, 12.0)), "tried.0.positions"),
        (AddedDevices(PENDULUM, 20), "separation"),
        (AddedDevices(InterphaseSpacer(0.0, 20.0, ("this", "top")), 1, (60.0,)), "tried.0.between"),
        (AddedSpoiler(AirflowSpoiler(0.0, 130.0, CALM)), "tried.0.length"),
    ):
        with pytest.raises(InvalidSpec) as caught:
            rows(source_line(2), remedy, separation=8.0)
        assert field in [fault.field for fault in caught.value.faults]
    with pytest.raises(InvalidSpec, match="not both"):
        ChangedTension()
    with pytest.raises(InvalidSpec, match="number of positions"):
        AddedDevices(PENDULUM, 2, (1.0,))


def test_progress_rises() -> None:
    progress: list[Progress] = []
    asked = only(Model.HYBRID, loops=(1,), wind_speeds=())
    driven(compare(explicit(source_line(1)), asked, Remedies((LIST[1],)), NO_SAMPLES), progress.append)
    fractions = [step.fraction for step in progress]
    assert fractions == sorted(fractions)
    assert fractions[-1] == pytest.approx(1.0)


def test_phases_that_a_spacer_ties_are_compared_by_the_finite_element_model() -> None:
    """The other phase's ice takes the motion: at 2.40 m/s the line gallops alone, tied it rests (validation.md)."""
    calm = replace(ICE_AT_40, vertical=(0.3, *ICE_AT_40.vertical[1:]))
    line = source_line(2)
    line = replace(line, phases=(Phase("top", 7.0, 0.0, ice=replace(line.ice, aerodynamics=calm)),))
    asked = only(Model.FINITE_ELEMENT, loops=(1,), finite_element_loops=(1,), wind_speeds=(4.0,))
    tried = Remedies((AddedDevices(InterphaseSpacer(0.0, 20.0, ("this", "top")), 1),))
    first, tied = finished(compare(explicit(line), asked, tried, Uncertainty(4))).remedies
    assert first.onset_m_per_s == pytest.approx(2.403, abs=2e-3)
    assert (tied.kind, tied.change, tied.gallops, tied.onset_m_per_s) == ("interphase_spacer", "better", "no", None)
    assert tied.arrangements == 3
    assert tied.improves is None
