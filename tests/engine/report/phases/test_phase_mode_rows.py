"""The rows of the modes of tied phases."""

import pytest

from engine.assemblies.numbered_modes import all_modes
from engine.assemblies.phase_modes import modes_of_phases
from engine.assemblies.phases import assembled_phases
from engine.report.phases.phase_mode_rows import lowest_frequencies, phase_mode_rows
from engine.spec import Analysis, InterphaseSpacer
from tests.builders import phases_line


def test_rows_say_how_phases_move_and_frequencies_are_the_lowest_of_so_many_loops() -> None:
    whole = assembled_phases(phases_line(InterphaseSpacer(62.94, 0.0, ("this", "top"))))
    modes = all_modes(whole.assembly)
    rows = phase_mode_rows(whole, modes, modes_of_phases(whole, modes, (1,)))
    alike, against = rows[:2]
    assert (alike.direction, alike.mode, alike.loops, alike.phase) == ("vertical", 1, 1, "this")
    assert (alike.phase_shares, alike.phase_motion) == ("0.5000 0.5000", "1.000 1.000")
    assert (against.mode, against.loops, against.phase_motion) == (4, 2, "1.000 -1.000")
    assert alike.frequency_hz == pytest.approx(0.48152, abs=1e-5)
    (one, two) = lowest_frequencies(rows, Analysis(loops=(1, 2)))
    assert one.vertical_hz == alike.frequency_hz
    assert one.horizontal_hz == min(row.frequency_hz or 9.0 for row in rows if row.direction == "horizontal")
    assert (two.vertical_hz, two.horizontal_hz, two.outcome) == (against.frequency_hz, None, "converged")
