"""The modes of sections against the figures of theory section 16, and in limits that are known."""

from dataclasses import replace

import numpy as np
import pytest

from engine.assemblies.assembled_line import AssembledLine, assembled_section
from engine.assemblies.numbered_modes import (
    NumberedModes,
    all_modes,
    directional_modes,
    largest_member,
    loops_of,
    member_shares,
)
from engine.mechanics.modes import directional_shapes
from engine.spec import Line
from tests.builders import FIVE_SPANS, STIFF_STRINGS, THREE_SPANS, section_line

VERTICAL, HORIZONTAL, TORSIONAL = range(3)

# frequency [Hz], direction and the span, or the spans, of the largest motion
FIVE = [
    (0.15443, HORIZONTAL, {3}),
    (0.16186, HORIZONTAL, {2, 4}),
    (0.17195, HORIZONTAL, {3}),
    (0.18123, HORIZONTAL, {1, 5}),
    (0.18518, HORIZONTAL, {1, 2, 3, 4, 5}),
    (0.18698, VERTICAL, {3}),
    (0.18721, VERTICAL, {2, 4}),
    (0.18795, VERTICAL, {3}),
    (0.19162, VERTICAL, {1, 5}),
]
THREE = [
    (0.16346, HORIZONTAL, {3}),
    (0.17606, HORIZONTAL, {2}),
    (0.18518, VERTICAL, {3}),
    (0.19561, HORIZONTAL, {1}),
    (0.20131, VERTICAL, {1}),
    (0.32702, HORIZONTAL, {3}),
    (0.33850, VERTICAL, {3}),
    (0.35225, HORIZONTAL, {2}),
]


def hertz(modes: NumberedModes) -> np.ndarray:
    return np.asarray(np.sqrt(np.maximum(modes.squares, 0.0)) / (2.0 * np.pi))


def listed(whole: AssembledLine, count: int) -> list[tuple[float, int, int]]:
    """Return frequency, direction and largest span of the lowest modes that move up or across, as the theory page."""
    rows = []
    for direction in (VERTICAL, HORIZONTAL):
        modes = directional_modes(whole.assembly, direction)
        largest = largest_member(member_shares(whole.assembly, modes.displacement)) + 1
        kept = modes.direction == direction
        rows += [(f, direction, span) for f, span in zip(hertz(modes)[kept], largest[kept], strict=True)]
    return sorted(rows)[:count]


@pytest.mark.parametrize(("lengths", "expected"), [(FIVE_SPANS, FIVE), (THREE_SPANS, THREE)], ids=["five", "three"])
def test_the_modes_are_those_of_the_theory_page(
    lengths: tuple[float, ...], expected: list[tuple[float, int, set[int]]]
) -> None:
    found = listed(assembled_section(section_line(lengths, elements=20)), len(expected))
    for (frequency, direction, span), (known, its_direction, its_spans) in zip(found, expected, strict=True):
        assert frequency == pytest.approx(known, abs=6e-6)
        assert direction == its_direction
        assert span in its_spans


def test_the_fifth_vertical_mode_of_five_equal_spans_moves_them_all_alike() -> None:
    whole = assembled_section(section_line(elements=20))
    modes = directional_modes(whole.assembly, VERTICAL)
    fifth = modes.place(VERTICAL, 5)
    assert hertz(modes)[fifth] == pytest.approx(0.33649, abs=6e-6)
    assert member_shares(whole.assembly, modes.displacement[fifth]) == pytest.approx([0.2] * 5, abs=1e-4)


def test_all_motions_together_hardly_change_the_frequencies() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2))
    together = all_modes(whole.assembly)
    for direction in (VERTICAL, HORIZONTAL, TORSIONAL):
        alone = directional_modes(whole.assembly, direction)
        for number in (1, 2, 3):
            own = hertz(alone)[alone.place(direction, number)]
            assert hertz(together)[together.place(direction, number)] == pytest.approx(own, rel=2e-3)


def test_strings_that_cannot_swing_make_single_spans() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, string=STIFF_STRINGS))
    shapes = directional_shapes(whole.members.matrices, whole.members.profile.arc_length, (1, 2))
    for direction in (VERTICAL, HORIZONTAL, TORSIONAL):
        modes = directional_modes(whole.assembly, direction)
        single = np.sort(shapes.angular_frequency[:, :, direction].reshape(-1))
        found = 2.0 * np.pi * np.array([hertz(modes)[modes.place(direction, k)] for k in range(1, 7)])
        assert found == pytest.approx(single, rel=1e-6)


def test_the_same_spans_in_the_other_order_have_mirrored_modes() -> None:
    one, other = (assembled_section(section_line(lengths)) for lengths in (THREE_SPANS, THREE_SPANS[::-1]))
    for direction in (VERTICAL, HORIZONTAL, TORSIONAL):
        modes, mirrored = (directional_modes(whole.assembly, direction) for whole in (one, other))
        assert modes.squares[:6] == pytest.approx(mirrored.squares[:6], rel=1e-8)
        shares = member_shares(one.assembly, modes.displacement[:6])
        assert shares == pytest.approx(member_shares(other.assembly, mirrored.displacement[:6])[:, ::-1], abs=1e-6)


def heavy_bundle(line: Line) -> Line:
    return replace(line, ice=replace(line.ice, eccentricity_y=0.0, eccentricity_z=0.0))


def test_equal_torsional_modes_are_divided_between_the_spans_in_order() -> None:
    whole = assembled_section(heavy_bundle(section_line(subconductors=2)))
    modes = directional_modes(whole.assembly, TORSIONAL)
    shares = member_shares(whole.assembly, modes.displacement[:5])
    assert shares == pytest.approx(np.eye(5), abs=1e-9)


@pytest.mark.parametrize("loops", [1, 2, 3])
def test_loops_are_counted_in_a_shape_with_moving_ends(loops: int) -> None:
    place = np.linspace(0.0, 1.0, 21)
    assert loops_of(-0.7 * np.sin(loops * np.pi * place) + 0.1) == loops
