"""The finite element model of a section: which modes it combines, and its limit of single spans."""

from dataclasses import replace

import numpy as np
import pytest

from engine.assemblies.assembled_finite_element import assembled_finite_element, modes_together
from engine.assemblies.assembled_line import assembled_section
from engine.assemblies.numbered_modes import all_modes, largest_member, member_shares
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.spec import Analysis, Damping, DampingModel, LongitudinalInertia, Stretching
from tests.builders import STIFF_STRINGS, THREE_SPANS, finite_element, section_line

FULL = Analysis(longitudinal_inertia=LongitudinalInertia.CONDENSED, stretching=Stretching.INCLUDED)


def test_vertical_modes_bring_their_partners() -> None:
    whole = assembled_section(section_line(subconductors=2))
    modes = all_modes(whole.assembly)
    chosen = modes_together(whole, modes, (1, 2))
    assert modes.direction[chosen].tolist() == [0, 0, 1, 1, *[2] * 5]
    assert modes.number[chosen].tolist() == [1, 2, 5, 4, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("damping", list(DampingModel))
def test_strings_that_cannot_swing_give_the_critical_winds_of_single_spans(damping: DampingModel) -> None:
    line = section_line(THREE_SPANS, subconductors=2, interest=3, string=STIFF_STRINGS)
    line = replace(line, damping=replace(line.damping, model=damping))
    whole = assembled_section(line)
    modes = all_modes(whole.assembly)
    # vertical modes 1 and 3 are those of two loops and of one loop of the longest span
    chosen = modes_together(whole, modes, (1, 3))
    assert set(largest_member(member_shares(whole.assembly, modes.displacement[chosen])).tolist()) == {2}
    found = critical_wind_speeds(assembled_finite_element(whole, modes, chosen, FULL), 30.0)
    single = critical_wind_speeds(finite_element(whole.members.lines[2], (1, 2), FULL), 30.0)
    assert found.wind_speed.size
    assert found.wind_speed == pytest.approx(single.wind_speed, rel=2e-4)


def test_all_members_damp_alike_per_length() -> None:
    line = replace(section_line(THREE_SPANS, subconductors=2), damping=Damping(0.01, 0.02, 0.03))
    whole = assembled_section(line)
    modes = all_modes(whole.assembly)
    vertical = np.array([modes.place(0, k) for k in (1, 2)])
    damping = assembled_finite_element(whole, modes, vertical, FULL).damping[0]
    assert damping[0, 0] == pytest.approx(damping[1, 1], rel=1e-2)  # the same coefficient at every frequency
    assert abs(damping[0, 1]) < 1e-2 * damping[0, 0]
