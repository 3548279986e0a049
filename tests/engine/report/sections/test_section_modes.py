"""The table of the modes of a section."""

import numpy as np
import pytest

from engine.assemblies.assembled_line import assembled_section
from engine.assemblies.numbered_modes import directional_modes
from engine.report.sections.section_modes import section_mode_rows, share_text
from engine.spec import Model
from tests.builders import section_line


def test_rows_name_the_span_that_moves_most_and_the_shares_of_all() -> None:
    whole = assembled_section(section_line(elements=20))
    rows = section_mode_rows(whole, Model.HYBRID, directional_modes(whole.assembly, 0), (1, 2, 5))
    assert [(row.direction, row.mode, row.span) for row in rows] == [
        ("vertical", 1, 3),
        ("vertical", 2, 2),
        ("vertical", 5, 1),
    ]
    assert [row.frequency_hz for row in rows] == pytest.approx([0.18698, 0.18721, 0.33649], abs=6e-6)
    shares = np.array([[float(text) for text in row.span_shares.split()] for row in rows])
    assert shares.sum(axis=1) == pytest.approx(np.ones(3), abs=2e-4)
    assert shares[2] == pytest.approx([0.2] * 5, abs=1e-4)


def test_a_span_that_its_ice_turns_over_has_no_torsional_frequency() -> None:
    whole = assembled_section(section_line())  # single conductors: the ice moment exceeds their torsional stiffness
    rows = section_mode_rows(whole, Model.HYBRID, directional_modes(whole.assembly, 2), (1,))
    assert [row.frequency_hz for row in rows] == [None]


def test_shares_are_written_with_four_digits() -> None:
    assert share_text([0.25, 0.75]) == "0.2500 0.7500"
