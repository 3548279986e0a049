"""The hybrid model of a section, from its definition and in the limit of single spans."""

from dataclasses import replace

import numpy as np
import pytest

from engine.arrays import FloatArray
from engine.assemblies.assembled_hybrid import assembled_hybrid, assembled_published_load, groups_of
from engine.assemblies.assembled_line import AssembledLine, assembled_section
from engine.assemblies.assembly import by_member
from engine.assemblies.hybrid_shapes import hybrid_shapes
from engine.assemblies.shared_tension import shared_stiffness
from engine.mechanics.finite_elements import U, V, W
from engine.mechanics.modes import directional_shapes
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.models.stretching import dynamic_tension, restoring_force, slope_points, span_stiffness
from engine.spec import AerodynamicModel, Analysis, LongitudinalInertia, Model, Stretching
from tests.builders import STIFF_STRINGS, THREE_SPANS, hybrid, published, section_line

FULL = Analysis(
    models=(Model.HYBRID,),
    longitudinal_inertia=LongitudinalInertia.CONDENSED,
    stretching=Stretching.INCLUDED,
)


def model_of(whole: AssembledLine, number: int, analysis: Analysis = FULL) -> ReducedModel:
    shapes = hybrid_shapes(whole, (number,), analysis)
    return take(assembled_hybrid(whole, shapes, (number,), analysis), (slice(None), 0))


def test_numbers_are_grouped_by_their_need_of_relief() -> None:
    shapes = hybrid_shapes(assembled_section(section_line(subconductors=2)), (1, 2, 5), FULL)
    assert groups_of(shapes) == [(5,), (1, 2)]


@pytest.mark.parametrize(("number", "loops"), [(1, 2), (3, 1)])
@pytest.mark.parametrize("inertia", list(LongitudinalInertia))
def test_a_span_between_strings_that_cannot_swing_is_a_single_span(
    inertia: LongitudinalInertia, number: int, loops: int
) -> None:
    analysis = replace(FULL, longitudinal_inertia=inertia)
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, interest=3, string=STIFF_STRINGS))
    section = model_of(whole, number, analysis)
    single = take(hybrid(whole.members.lines[2], loops, analysis), [0])
    assert section.uncoupled_squares[:, :3] == pytest.approx(single.uncoupled_squares[:, :3], rel=1e-6)
    if loops == 2:  # relieved by the mode of one loop of the same span
        shapes = directional_shapes(whole.members.matrices, whole.members.profile.arc_length, (1,))
        one_loop = shapes.angular_frequency[2, 0, 0] ** 2
        assert section.uncoupled_squares[0, 3] == pytest.approx(one_loop, rel=1e-6)
    found, expected = (critical_wind_speeds(model, 30.0) for model in (section, single))
    assert found.wind_speed.size
    assert found.wind_speed == pytest.approx(expected.wind_speed, rel=1e-6)
    assert found.angular_frequency == pytest.approx(expected.angular_frequency, rel=1e-6)


def fields_of(whole: AssembledLine, q: FloatArray) -> FloatArray:
    """Return U, V, W, Theta of a motion of the model of the first vertical mode: (members, 4, nodes)."""
    shapes = hybrid_shapes(whole, (1,), FULL)
    f_u, *others = shapes.displacement[0]
    f_v = f_u + others[0]
    relief = shapes.relief[0]
    system = whole.assembly.stiffness
    # f_w, f_theta and the relief take f_u with them statically
    rows = [f_v, *(row - (f_u @ system @ row) / (f_u @ system @ f_u) * f_u for row in (*others[1:], relief))]
    return by_member(np.tensordot(q, np.stack(rows), axes=1), whole.assembly.members)


def test_stretching_is_the_energy_of_all_spans_with_the_pull_of_the_strings() -> None:
    whole = assembled_section(section_line(THREE_SPANS))
    model = model_of(whole, 1)
    assert model.stretching is not None
    q = np.array([1.1, -0.4, 0.2, 0.3])
    at = slope_points(*whole.members.parts[:3])
    k = span_stiffness(*whole.members.parts[:2], at)

    def stretches(q: FloatArray) -> tuple[FloatArray, FloatArray]:
        fields = fields_of(whole, q)
        linear, square = np.zeros((2, 3))
        for i in range(3):
            slopes = [np.zeros(at.weight.shape[1:]) for _ in range(2)]
            for row, field in zip(slopes, (V, W), strict=True):
                for e in range(at.weight.shape[1]):
                    row[e] = at.slopes[i, e] @ fields[i, field, 2 * e : 2 * e + 3]
            x, y, _ = np.moveaxis(at.direction[i], -1, 0)
            linear[i] = (y / x * slopes[0] * at.weight[i]).sum() + fields[i, U, -1] - fields[i, U, 0]
            square[i] = (0.5 * (slopes[0] ** 2 + slopes[1] ** 2) / x * at.weight[i]).sum()
        return linear, square

    def energy(q: FloatArray) -> float:
        e, h = stretches(q)
        return float((k * e * h).sum() + 0.5 * h @ shared_stiffness(whole) @ h)

    step = 1e-5
    numeric = [(energy(q + step * row) - energy(q - step * row)) / (2.0 * step) for row in np.eye(4)]
    assert restoring_force(model.stretching, q[None, None])[0, 0] == pytest.approx(numeric, rel=1e-6)
    e, h = stretches(q)
    expected = k * e + shared_stiffness(whole) @ h
    assert dynamic_tension(model.stretching, q[None, None])[0, 0] == pytest.approx(expected, rel=1e-9)


def test_equal_spans_do_not_care_which_one_is_of_interest() -> None:
    models = [model_of(assembled_section(section_line(subconductors=2, interest=i)), 2) for i in (1, 3)]
    one, other = (critical_wind_speeds(model, 30.0).wind_speed for model in models)
    assert one == pytest.approx(other, rel=1e-9)


def test_the_load_with_relative_wind_damps_more() -> None:
    line = section_line(THREE_SPANS, subconductors=2)
    line = replace(line, ice=replace(line.ice, aerodynamics=replace(line.ice.aerodynamics, at_rest=(0.0, 1.0, 0.0))))
    whole = assembled_section(line)
    relative = replace(FULL, aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
    published, full = (critical_wind_speeds(model_of(whole, 1, asked), 30.0) for asked in (FULL, relative))
    assert full.wind_speed.size
    assert full.wind_speed[0] != pytest.approx(published.wind_speed[0], rel=1e-6)


def test_the_published_load_of_a_span_by_itself_is_that_of_a_single_span() -> None:
    whole = assembled_section(section_line(THREE_SPANS, subconductors=2, interest=3, string=STIFF_STRINGS))
    section = assembled_published_load(whole, assembled_hybrid(whole, hybrid_shapes(whole, (3,), FULL), (3,), FULL))
    single = published(whole.members.lines[2])
    assert section.load.table[0, 0, 0] == pytest.approx(single.load.table[0, 0], rel=1e-5)
