"""Motions are observed where they are largest, so that a line and its mirror image have equal numbers."""

import math
from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.report.observers.widest_places import widest_places
from engine.result import LimitCycleRow
from engine.spec import Analysis, BlowOut, DetuningPendulum, IceSegment, Line, Model, Spacer, Wind
from tests.builders import only, run, source_line
from tests.engine.mirror_images import mirrored

NODES = 21
S = np.linspace(0.0, 1.0, NODES)
REST = np.zeros((1, 1, 1))


def alone(shape: FloatArray, loops: int) -> tuple[float, FloatArray]:
    """Return the place of a motion of one vertical coordinate, and its shapes there."""
    shapes = np.zeros((1, 1, 3, NODES))
    shapes[0, 0, 0] = shape
    none = np.zeros(1, dtype=np.intp)
    found = widest_places(shapes, none, np.array([loops]), none, REST)
    return float(found.share[0]), found.shapes[0, 0]


@pytest.mark.parametrize("loops", [1, 2, 4])
def test_equal_antinodes_leave_the_first_one(loops: int) -> None:
    share, shapes = alone(np.sin(loops * np.pi * S), loops)
    assert share == pytest.approx(1.0 / (2.0 * loops), rel=1e-12)
    assert shapes[0] == pytest.approx(1.0, abs=4e-3)


def test_three_equal_loops_are_seen_in_the_middle() -> None:
    """Only that antinode is a node of ten elements; between nodes their parabolas are lower by 0.3 %."""
    share, shapes = alone(np.sin(3.0 * np.pi * S), 3)
    assert share == pytest.approx(0.5, rel=1e-12)
    assert abs(shapes[0]) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(("loops", "antinode"), [(2, 1), (3, 1), (3, 2), (4, 3)])
def test_the_largest_antinode_is_taken(loops: int, antinode: int) -> None:
    place = (2 * antinode + 1) / (2 * loops)
    lobe = np.abs(S - place) < 0.5 / loops
    share, _ = alone(np.sin(loops * np.pi * S) * np.where(lobe, 1.1, 1.0), loops)
    assert share == pytest.approx(place, rel=1e-12)


@pytest.mark.parametrize("top", [0.31, 0.35, 0.42, 0.6, 0.73])
def test_a_motion_largest_between_the_nodes_is_seen_there(top: float) -> None:
    share, shapes = alone(np.sin(np.pi * S ** (math.log(0.5) / math.log(top))), 1)
    assert share == pytest.approx(top, abs=5e-3)
    assert shapes[0] == pytest.approx(1.0, abs=3e-3)


def test_of_several_coordinates_the_motion_counts_not_the_shape() -> None:
    """One loop and two loops in step are largest off the middle, to the side where they add."""
    shapes = np.zeros((2, 2, 3, NODES))
    shapes[:, 0, 0], shapes[:, 1, 0] = np.sin(np.pi * S), np.sin(2.0 * np.pi * S)
    motion = np.sin(2.0 * np.pi * np.arange(48) / 48)[None, :, None] * np.array([[1.0, 0.5], [1.0, -0.5]])[:, None]
    none = np.zeros(2, dtype=np.intp)
    found = widest_places(shapes, none, np.array([1, 1]), none, motion)
    fine = np.linspace(0.0, 1.0, 10_001)
    sizes = np.sin(np.pi * fine) + 0.5 * np.sin(2.0 * np.pi * fine)
    assert found.share[0] == pytest.approx(fine[sizes.argmax()], abs=3e-3)
    assert found.share[1] == pytest.approx(1.0 - found.share[0], abs=1e-9)
    seen = np.einsum("mk,mk->m", found.shapes[:, :, 0], np.array([[1.0, 0.5], [1.0, -0.5]]))
    assert seen == pytest.approx(np.full(2, sizes.max()), rel=1e-3)


def unsymmetric_line(seed: int) -> Line:
    """Return a twin with devices, ice and wind that differ from left to right."""
    generator = np.random.default_rng(seed)
    line = source_line(2)
    length = line.span.length
    first, second = np.sort(generator.uniform(0.1, 0.9, 2)) * length
    devices = (
        DetuningPendulum(float(first), float(generator.uniform(5.0, 20.0)), 0.35),
        Spacer(float(second), float(generator.uniform(3.0, 12.0)), 0.4),
    )
    stretch = IceSegment(0.0, float(generator.uniform(0.2, 0.8)) * length, mass=float(generator.uniform(2.0, 2.8)))
    chosen = generator.integers(0, 3)
    return replace(
        line,
        devices=devices if chosen != 1 else (),
        ice=replace(line.ice, segments=(stretch,)) if chosen != 0 else line.ice,
        wind=Wind(
            1.2929,
            profile=((0.0, float(generator.uniform(0.7, 1.0))), (length, float(generator.uniform(1.0, 1.3)))),
            blow_out=BlowOut(8.0, 1.0) if seed % 2 else None,
        ),
        span=replace(line.span, level_difference=float(generator.uniform(-6.0, 6.0))),
    )


def numbers(row: LimitCycleRow) -> tuple[float | None, ...]:
    return row.vertical_m, row.horizontal_m, row.torsional_rad, row.frequency_hz


@pytest.mark.parametrize("seed", range(6))
def test_a_line_and_its_mirror_image_have_equal_numbers(seed: int) -> None:
    line = unsymmetric_line(seed)
    asked = only(Model.HYBRID, loops=(1, 2, 3), wind_speeds=(5.0, 9.0))
    rows, images = ([r for r in run(one, asked).limit_cycles if r.kind == "periodic"] for one in (line, mirrored(line)))
    assert rows
    assert len(rows) == len(images)
    for row, image in zip(rows, images, strict=True):
        assert (row.loops, row.wind_speed_m_per_s, row.stability) == (
            image.loops,
            image.wind_speed_m_per_s,
            image.stability,
        )
        expected = [None if value is None else pytest.approx(value, rel=1e-5, abs=1e-9) for value in numbers(row)]
        assert list(numbers(image)) == expected
        assert image.observed_at_m == pytest.approx(line.span.length - row.observed_at_m, abs=1e-3)


def test_full_modes_of_a_line_and_its_mirror_image_have_equal_numbers() -> None:
    line = replace(source_line(2), devices=(DetuningPendulum(90.0, 12.0, 0.35),))
    asked = Analysis(models=(Model.FINITE_ELEMENT,), loops=(2,), finite_element_loops=(1, 2), wind_speeds=(5.0,))
    rows, images = ([r for r in run(one, asked).limit_cycles if r.kind == "periodic"] for one in (line, mirrored(line)))
    assert rows
    for row, image in zip(rows, images, strict=True):
        assert numbers(image) == pytest.approx(numbers(row), rel=1e-5)


def test_the_figures_of_the_source_are_those_of_its_point() -> None:
    """A symmetric line is observed at the first antinode, at which the source observes it."""
    asked = only(Model.HYBRID, loops=(1, 2), wind_speeds=(4.0, 6.0))
    for row in run(source_line(2), asked).limit_cycles:
        assert row.observed_at_m == pytest.approx(125.88 / (2 * row.loops), rel=1e-3)
