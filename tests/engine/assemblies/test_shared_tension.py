"""What neighbouring spans take of each other's stretch."""

import numpy as np
import pytest

from engine.assemblies.assembled_line import assembled_section
from engine.assemblies.shared_tension import shared_stiffness, span_pulls
from engine.mechanics.finite_elements import FIELDS, U
from engine.models.stretching import slope_points, span_stiffness
from engine.spec import SuspensionString
from tests.builders import STIFF_STRINGS, THREE_SPANS, section_line


def stiffness_of_spans(string: SuspensionString) -> tuple[np.ndarray, np.ndarray]:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, string=string))
    at = slope_points(*whole.members.parts[:3])
    return shared_stiffness(whole), span_stiffness(*whole.members.parts[:2], at)


def test_strings_that_cannot_swing_leave_every_span_its_own() -> None:
    shared, own = stiffness_of_spans(STIFF_STRINGS)
    assert shared == pytest.approx(np.diag(own), rel=1e-4, abs=1e-4 * own[0])


def test_free_strings_make_the_tension_that_of_one_long_span() -> None:
    shared, own = stiffness_of_spans(SuspensionString(1e7, 1.0))
    whole = 1.0 / (1.0 / own).sum()
    assert shared == pytest.approx(np.full((3, 3), whole), rel=0.01)  # T U'^2 holds a little


def test_the_pull_of_a_span_is_that_of_its_ends_and_of_its_slopes() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2))
    pulls = span_pulls(whole).reshape(3, 3, 21, FIELDS)
    at = slope_points(*whole.members.parts[:3])
    k = span_stiffness(*whole.members.parts[:2], at)
    for i in range(3):
        assert pulls[i, i, [0, -1], U] == pytest.approx([-2.0 * k[i], 2.0 * k[i]])
        others = [j for j in range(3) if j != i]
        assert not pulls[i, others].any()
        # e of a lift by one everywhere but at the ends is that of the ends, -y_xx being uniform: e = -int y_xx V dx
        lifted = pulls[i, i, :, 1] @ np.sin(np.pi * np.linspace(0.0, 1.0, 21)) / (2.0 * k[i])
        profile = whole.members.profile
        assert lifted == pytest.approx(-2.0 / np.pi * profile.arc_length[i] / profile.catenary_parameter[i], rel=1e-3)
