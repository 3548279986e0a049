"""The shape functions, and strain points on the catenary."""

import numpy as np
import pytest

from engine.mechanics.interpolation import element_nodes, shape_functions, strain_points
from engine.mechanics.static_profile import static_profile
from tests.builders import source_line


def test_each_shape_function_is_one_at_its_own_node_and_zero_at_the_others() -> None:
    values, _ = shape_functions(np.array([-1.0, 0.0, 1.0]))
    assert np.array_equal(values, np.eye(3))


def test_shape_functions_carry_every_quadratic_and_its_slope() -> None:
    local = np.linspace(-1.0, 1.0, 7)
    values, slopes = shape_functions(local)
    quadratic = np.array([[a * a - 2.0 * a + 3.0] for a in (-1.0, 0.0, 1.0)])
    assert (values @ quadratic)[:, 0] == pytest.approx(local**2 - 2.0 * local + 3.0, abs=1e-14)
    assert (slopes @ quadratic)[:, 0] == pytest.approx(2.0 * local - 2.0, abs=1e-14)


def test_strain_points_divide_the_length_of_the_catenary_along_its_tangent() -> None:
    line = source_line(2)
    profile = static_profile((line,))
    at = strain_points((line,), profile)
    assert at.weight.sum() == pytest.approx(profile.arc_length[0], rel=1e-6)
    assert np.linalg.norm(at.direction, axis=-1) == pytest.approx(np.ones(at.weight.shape), abs=1e-14)
    assert (at.weight * at.direction[..., 0]).sum() == pytest.approx(125.88, rel=1e-12)
    assert at.tension * at.direction[..., 0] == pytest.approx(np.full(at.weight.shape, 30000.0), rel=1e-12)
    assert element_nodes(profile, 10)[0, -1, -1] == pytest.approx([125.88, 0.0, 0.0], abs=1e-12)
