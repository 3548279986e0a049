"""Which modes of tied phases are combined, and how they are told apart."""

from dataclasses import replace

import numpy as np
import pytest

from engine.assemblies.numbered_modes import all_modes
from engine.assemblies.phase_modes import loops_of_modes, modes_of_phases, relative_motion
from engine.assemblies.phases import assembled_phases
from engine.spec import InterphaseSpacer, Phase
from tests.builders import phases_line, source_line

RIGID = InterphaseSpacer(62.94, 0.0, ("this", "top"))


def test_as_many_modes_of_each_direction_as_phases_times_loops() -> None:
    spacers = RIGID, replace(RIGID, between=("top", "highest"))
    line = replace(source_line(2), phases=(Phase("top", 7.0, 0.0), Phase("highest", 14.0, 0.0)), devices=spacers)
    whole = assembled_phases(line)
    modes = all_modes(whole.assembly)
    chosen = modes_of_phases(whole, modes, (1, 2))
    assert np.bincount(modes.direction[chosen]).tolist() == [6, 6, 6]
    assert np.unique(chosen).size == 18


def test_loops_and_relative_motion_of_two_equal_phases() -> None:
    whole = assembled_phases(phases_line(RIGID))
    modes = all_modes(whole.assembly)
    vertical = modes_of_phases(whole, modes, (1, 2))[:4]
    # alike in one loop; each by itself in two, whose node is at the spacer; against each other, held in the middle
    assert loops_of_modes(whole, modes, vertical).tolist() == [1, 2, 2, 2]
    motion = relative_motion(whole, modes, vertical)
    expected = np.array([[1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, -1.0]])
    assert motion == pytest.approx(expected, abs=1e-6)
