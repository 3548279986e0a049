"""Suspension strings as links between spans."""

import numpy as np
import pytest

from engine.assemblies.spans import spans_of
from engine.assemblies.strings import held_ends, string_joins
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W
from engine.mechanics.static_profile import static_profile
from engine.spec import GRAVITY
from tests.builders import THREE_SPANS, section_line


def test_a_string_is_a_pendulum_that_carries_the_conductor() -> None:
    line = section_line(THREE_SPANS)
    spans = spans_of(line)
    profile = static_profile(spans)
    freedoms = FIELDS * 21
    assert line.section is not None
    joins = string_joins(line.section.strings, spans, profile, freedoms)
    # theory section 16: (P + W/2)/l with P = n p (S_left + S_right)/2, mass W/(3 g), in X and in Z
    carried = 0.5 * 2.379 * GRAVITY * (profile.arc_length[:-1] + profile.arc_length[1:])
    expected = np.repeat((carried + 300.0) / 2.4, 2)
    assert joins.stiffness == pytest.approx(expected, rel=1e-9)
    assert joins.mass == pytest.approx([600.0 / (3.0 * GRAVITY)] * 4)
    moved = np.zeros(3 * freedoms)
    moved[[freedoms - FIELDS + U, freedoms + U]] = 1.0
    assert joins.links @ moved == pytest.approx([1.0, 0.0, 0.0, 0.0])
    assert joins.ties @ moved == pytest.approx(np.zeros(4))


def test_strings_hold_what_does_not_swing_and_dead_ends_everything() -> None:
    held = held_ends(3, FIELDS * 5).reshape(3, 5, FIELDS)
    assert held[0, 0].all()
    assert held[2, 4].all()
    assert held[:, [0, 4]][..., [V, THETA]].all()
    assert not held[1:, 0][:, [U, W]].any()
    assert not held[:2, 4][:, [U, W]].any()
    assert not held[:, 1:4].any()
