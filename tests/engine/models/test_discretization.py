from dataclasses import replace

import numpy as np
import pytest

from engine.mechanics.finite_elements import matrices
from engine.mechanics.modes import directional_shapes
from engine.models.discretization import (
    discretize,
    fields_in_space,
    shapes_at,
    shapes_in_wind,
    states_in_wind,
    with_wind_twist,
)
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import take
from engine.spec import Analysis, BlowOut, CrossSection, DetuningPendulum, Span, StaticTwist, Wind
from tests.builders import discretized, source_line
from tests.engine.synthetic_table import with_table

STORM = Wind(1.2929, blow_out=BlowOut(25.0, 1.2))


@pytest.mark.parametrize("loops", [1, 2, 3, 4])
def test_shapes_are_read_at_the_first_crest(loops: int) -> None:
    line = source_line(1)
    discretization = discretized(line)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2, 3, 4))
    model = take(hybrid_model(discretization, shapes, (loops,), Analysis()), 0)
    seen = shapes_at(model.shapes, np.array([1.0 / (2.0 * loops)]))[0]
    assert seen == pytest.approx(np.diag(np.diagonal(seen)), abs=1e-15)
    # W and the single conductor's Theta are sines of unit amplitude; four loops have 2.5 elements a half wave.
    assert np.diagonal(seen)[1:] == pytest.approx([1.0, 1.0], abs=4e-3)


def test_fields_in_the_plane_are_turned_back_to_vertical_and_horizontal() -> None:
    profile = discretized(replace(source_line(1), wind=STORM), source_line(1)).profile
    tilt = profile.tilt[0]
    assert profile.tilt[1] == 0.0
    fields = np.random.default_rng(1).normal(size=(2, 5, 3, 21))
    turned = fields_in_space(profile, fields)
    up, out, twist = np.moveaxis(fields[0], -2, 0)
    assert turned[0, :, 0] == pytest.approx(np.cos(tilt) * up + np.sin(tilt) * out, rel=1e-13)
    assert turned[0, :, 1] == pytest.approx(-np.sin(tilt) * up + np.cos(tilt) * out, rel=1e-13)
    assert turned[0, :, 2] == pytest.approx(twist, rel=1e-14)
    assert turned[1] == pytest.approx(fields[1], rel=1e-14)


@pytest.mark.parametrize("rise", [0.0, 30.0])
def test_matrices_in_the_plane_hold_the_energies_of_space(rise: float) -> None:
    span = Span(125.88, horizontal_tension=30_000.0, level_difference=rise)
    devices = (DetuningPendulum(40.0, 9.0, 0.4, 0.3),)
    line = replace(source_line(3), span=span, devices=devices, wind=STORM)
    turned = discretized(line)
    plain = matrices((line,), turned.profile, turned.sections)
    fields = np.random.default_rng(2).normal(size=(1, 6, 4, 21))
    in_plane, in_space = (
        x.swapaxes(-1, -2).reshape(6, -1) for x in (fields[0], fields_in_space(turned.profile, fields)[0])
    )
    for name in ("stiffness", "mass"):
        energy = in_plane @ getattr(turned.matrices, name)[0] @ in_plane.T
        expected = in_space @ getattr(plain, name)[0] @ in_space.T
        assert energy == pytest.approx(expected, abs=1e-11 * np.abs(expected).max())


def test_blow_out_does_not_turn_the_weight_of_ice() -> None:
    # The torsional stiffness of a conductor with its centre on the curve is GJ and the ice's weight, in any plane. Only
    # the arc of the blown-out curve differs, by 1e-4.
    line = source_line(1)
    still, blown = (discretized(x).matrices.stiffness[0, 3::4, 3::4] for x in (line, replace(line, wind=STORM)))
    size = np.abs(still).max()
    assert blown == pytest.approx(still, abs=3e-4 * size)
    upright = discretized(replace(line, ice=replace(line.ice, eccentricity_y=0.0))).matrices.stiffness[0, 3::4, 3::4]
    assert np.abs(upright - still).max() > 5e-3 * size


def test_shapes_in_the_wind_are_those_of_the_eigenproblems_there() -> None:
    span = Span(200.0, horizontal_tension=30_000.0, level_difference=20.0)
    free = replace(source_line(3).bundle, section=CrossSection.FREE)
    devices = (DetuningPendulum(40.0, 9.0, 0.4, 0.3),)
    hung = replace(source_line(3), span=span, bundle=free, devices=devices, wind=STORM)
    lines = [with_table(line, angle) for line, angle in ((source_line(1), -40.0), (hung, 20.0))]
    still = discretize(lines, StaticTwist.SOLVED)
    states = states_in_wind(with_wind_twist(still, np.array([8.0, 20.0])), np.arange(2))
    assert np.abs(states.sections.twist).max() > 0.3
    shapes = directional_shapes(still.matrices, still.profile.arc_length, (1, 2))
    found = shapes_in_wind(states, shapes)
    expected = directional_shapes(states.matrices, states.profile.arc_length, (1, 2))
    assert found.angular_frequency == pytest.approx(expected.angular_frequency, rel=1e-10)
    assert found.nodal == pytest.approx(expected.nodal, abs=1e-9)
    for own, other in zip(found.modes, expected.modes, strict=True):
        assert own.squares == pytest.approx(other.squares, rel=1e-9)
        assert np.abs(own.vectors[:, :4]) == pytest.approx(np.abs(other.vectors[:, :4]), abs=1e-9)
    turned = found.angular_frequency[..., 2].reshape(2, 2, 2)
    assert (np.abs(turned[0] / turned[1] - 1.0) > 1e-3).any()
