"""The mirror image of a line moves as the line does, seen from its other end."""

import math
from dataclasses import replace

import pytest

from engine.spec import AirflowSpoiler, DetuningPendulum, IceSegment, Line, Model, Support, Supports
from engine.studies.both_ends import is_symmetric, larger, mirrored, views
from engine.uncertainty.outcomes import AtWind, SampleOutcome, State
from tests.builders import ICE_AT_40, only, source_line, stable_cycles

ASKED = only(Model.HYBRID, loops=(2,), wind_speeds=(4.0,))
LEANING = replace(source_line(2), devices=(DetuningPendulum(30.0, 15.0, 0.4),))


def test_a_mirror_image_of_a_mirror_image_is_the_line() -> None:
    line = replace(
        LEANING,
        devices=(DetuningPendulum(30.0, 15.0, 0.4), AirflowSpoiler(10.0, 20.0, ICE_AT_40)),
        supports=Supports(left=Support(dead_end=True)),
        ice=replace(LEANING.ice, segments=(IceSegment(0.0, 40.0, mass=2.4),)),
        wind=replace(LEANING.wind, profile=((0.0, 0.7), (60.0, 1.2))),
    )
    image = mirrored(line)
    assert image.devices[1].end[1] == pytest.approx(115.88)
    assert image.supports.right.dead_end
    assert image.ice.segments[0].start == pytest.approx(85.88)
    assert [factor for _, factor in image.wind.profile] == [1.2, 0.7]
    again = mirrored(image)
    assert again.devices[0].end[1] == pytest.approx(30.0)
    assert again.ice.segments[0].stop == pytest.approx(40.0)


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (source_line(2), True),
        (LEANING, False),
        (replace(LEANING, devices=(*LEANING.devices, DetuningPendulum(95.88, 15.0, 0.4))), True),
        (replace(LEANING, devices=(*LEANING.devices, DetuningPendulum(95.88, 16.0, 0.4))), False),
    ],
)
def test_symmetry_is_that_of_what_stands_on_the_span(line: Line, expected: bool) -> None:
    assert is_symmetric(line) is expected


def test_both_ends_see_one_onset_and_two_amplitudes() -> None:
    alone, leaning = views([source_line(2), LEANING], ASKED)
    assert not isinstance(alone, State)
    assert not isinstance(leaning, State)
    assert len(alone) == 1
    one, other = leaning
    onsets = [result.verdict[0].onset_m_per_s for result in (one, other)]
    assert onsets[0] == pytest.approx(onsets[1], rel=1e-6)
    (left,), (right,) = (stable_cycles(each, loops=2, wind_speed=4.0) for each in (one, other))
    assert left.frequency_hz == pytest.approx(right.frequency_hz, rel=1e-6)
    assert left.vertical_m != pytest.approx(right.vertical_m, rel=1e-3)


def test_the_larger_motion_of_a_sample_counts() -> None:
    def sample(size: float) -> SampleOutcome:
        at = AtWind(State.GALLOPS, (size, 0.0, 0.0))
        return SampleOutcome(2.0, (at,), at)

    assert larger(sample(1.0), sample(2.0)).overall.amplitudes[0] == 2.0
    assert larger(sample(2.0), sample(1.0)).overall.amplitudes[0] == 2.0
    assert math.isnan(larger(sample(2.0), sample(math.nan)).overall.amplitudes[0])
