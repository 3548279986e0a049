"""Three-node isoparametric elements on the reference curve, and the points at which strain is integrated. Section 3."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.cross_sections import gauss_rule
from engine.mechanics.static_profile import StaticProfile, coordinates
from engine.spec import Line

STIFFNESS_POINTS = 2  # three would lock the membrane strain of the curved element


@dataclass(frozen=True, slots=True)
class StrainPoints:
    """Quadrature points of the strain energy.

    values: (points, 3) and slopes: (lines, elements, points, 3), shape functions and their derivatives by s; weight:
    (lines, elements, points) = ds [m]; direction: (lines, elements, points, 3) = (x', y', z'); tension: T [N] there.
    """

    values: FloatArray
    slopes: FloatArray
    weight: FloatArray
    direction: FloatArray
    tension: FloatArray


def strain_points(lines: Sequence[Line], profile: StaticProfile) -> StrainPoints:
    """Return the points at which the strain energy of lines with equal numbers of elements is integrated."""
    abscissae, weights = gauss_rule(STIFFNESS_POINTS)
    values, derivative = shape_functions(abscissae)
    metric = derivative @ element_nodes(profile, lines[0].span.elements)
    jacobian = np.linalg.norm(metric, axis=-1)
    direction = metric / jacobian[..., None]
    tension = profile.horizontal_tension[:, None, None] / direction[..., 0]
    return StrainPoints(values, derivative / jacobian[..., None], weights * jacobian, direction, tension)


def shape_functions(local: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return values and local derivatives of the quadratic shape functions, each local.shape + (3,)."""
    values = [0.5 * local * (local - 1.0), 1.0 - local**2, 0.5 * local * (local + 1.0)]
    slopes = [local - 0.5, -2.0 * local, local + 0.5]
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)


def element_nodes(profile: StaticProfile, elements: int) -> FloatArray:
    """Return the node positions of each element [m]: (lines, elements, 3 nodes, 3 coordinates)."""
    arc = profile.arc_length[:, None] * np.linspace(0.0, 1.0, 2 * elements + 1)
    first = 2 * np.arange(elements)[:, None] + np.arange(3)
    return coordinates(profile, arc)[:, first]
