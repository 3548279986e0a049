"""The shapes of a section's hybrid models."""

import numpy as np
import pytest

from engine.assemblies.assembled_line import assembled_section, product_along
from engine.assemblies.assembly import by_member
from engine.assemblies.hybrid_shapes import hybrid_shapes
from engine.assemblies.numbered_modes import largest_member, member_shares
from engine.mechanics.finite_elements import THETA, U, V, W
from engine.mechanics.modes import directional_shapes
from engine.outcome import InvalidSpec
from engine.spec import Analysis, Stretching
from tests.builders import STIFF_STRINGS, THREE_SPANS, section_line

STRETCHING = Analysis(stretching=Stretching.INCLUDED)


def test_partners_of_five_equal_spans_move_in_the_same_pattern() -> None:
    whole = assembled_section(section_line(subconductors=2))
    shapes = hybrid_shapes(whole, (1, 2, 3, 4), STRETCHING)
    # vertical modes alternate the most in the lowest one, horizontal modes in the highest of one loop a span
    assert (shapes.partner + 1).tolist() == [5, 4, 3, 2]
    fields = by_member(shapes.displacement.sum(axis=1), 5)
    middle = fields[..., 10]
    for k in range(4):
        pattern = middle[:, k, V] / np.abs(middle[:, k, V]).max()
        twist = middle[:, k, THETA] / np.abs(middle[:, k, THETA]).max()
        assert twist == pytest.approx(pattern, abs=0.02)
        assert pattern[int((np.abs(pattern) > 0.999).argmax())] > 0.0
        assert float(middle[:, k, W] @ pattern) > 0.0


def test_shapes_are_normalized_along_the_whole_section() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, interest=3))
    shapes = hybrid_shapes(whole, (1, 2), STRETCHING)
    fields = by_member(shapes.displacement.sum(axis=1), 3)
    size = 2.0 / whole.members.profile.arc_length[2] * product_along(whole, fields, fields).sum(axis=0)
    assert size[:, [V, W, THETA]] == pytest.approx(np.ones((2, 3)))


def test_a_mode_that_lifts_all_spans_needs_no_relief() -> None:
    whole = assembled_section(section_line(subconductors=2))
    shapes = hybrid_shapes(whole, (1, 4, 5, 6), STRETCHING)
    assert shapes.relieved.tolist() == [True, True, False, True]
    assert not hybrid_shapes(whole, (1, 4, 5, 6), Analysis()).relieved.any()


def test_two_loops_of_a_span_by_itself_are_relieved_by_its_one_loop() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, string=STIFF_STRINGS))
    shapes = hybrid_shapes(whole, (1, 2, 4), STRETCHING)  # two loops of each span
    assert shapes.relieved.all()
    single = directional_shapes(whole.members.matrices, whole.members.profile.arc_length, (1,)).nodal[:, 0, V]
    for k in range(3):
        span = int(largest_member(member_shares(whole.assembly, shapes.displacement[k, [0, 1]].sum(axis=0))))
        found = by_member(shapes.relief[k], 3)[:, V]
        own, expected = found[span] / np.abs(found).max(), single[span] / np.abs(single[span]).max()
        assert np.abs(own) == pytest.approx(np.abs(expected), abs=1e-5)
        assert np.abs(np.delete(found, span, axis=0)).max() < 1e-5 * np.abs(found).max()


def test_the_torsion_of_a_span_by_itself_is_that_of_a_single_span() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, string=STIFF_STRINGS))
    single = directional_shapes(whole.members.matrices, whole.members.profile.arc_length, (1,))
    shapes = hybrid_shapes(whole, (3,), STRETCHING)  # one loop of the longest span
    fields = by_member(shapes.displacement[0], 3)[2]
    for field in (U, V, W, THETA):
        own, expected = fields[field, field], single.nodal[2, 0, field]
        # L of the normalization is that of the first span
        scale = np.sqrt(whole.members.profile.arc_length[0] / whole.members.profile.arc_length[2])
        assert own == pytest.approx(scale * expected, abs=1e-6)


def test_a_number_beyond_all_modes_is_refused() -> None:
    whole = assembled_section(section_line(THREE_SPANS, elements=2))
    with pytest.raises(InvalidSpec) as error:
        hybrid_shapes(whole, (1, 500), STRETCHING)
    assert error.value.faults[0].field == "loops"
