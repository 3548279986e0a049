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
    (lines, elements, points) = ds [m]; direction: (lines, elements, points, 3) = (x', y', z'); section_slopes:
    (lines, elements, points, 2), as the function of this name returns them; tension: T [N] there.
    """

    values: FloatArray
    slopes: FloatArray
    weight: FloatArray
    direction: FloatArray
    section_slopes: FloatArray
    tension: FloatArray


def strain_points(lines: Sequence[Line], profile: StaticProfile) -> StrainPoints:
    """Return the points at which the strain energy of lines with equal numbers of elements is integrated."""
    abscissae, weights = gauss_rule(STIFFNESS_POINTS)
    values, derivative = shape_functions(abscissae)
    metric = derivative @ element_nodes(profile, lines[0].span.elements)
    jacobian = np.linalg.norm(metric, axis=-1)
    direction = metric / jacobian[..., None]
    tension = profile.horizontal_tension[:, None, None] / direction[..., 0]
    return StrainPoints(
        values,
        derivative / jacobian[..., None],
        weights * jacobian,
        direction,
        section_slopes(lines, direction),
        tension,
    )


def chords(lines: Sequence[Line]) -> FloatArray:
    """Return cosine and sine of the slope of each line's chord: (2, lines, 1, 1)."""
    along, up = (
        np.array(values) for values in zip(*((x.span.length, x.span.level_difference) for x in lines), strict=True)
    )
    return np.asarray(np.stack([along, up]) / np.hypot(along, up))[..., None, None]


def section_slopes(lines: Sequence[Line], direction: FloatArray) -> FloatArray:
    """Return the slopes of the curve against the normal of the cross-section, up and out: (lines, ..., 2).

    Cross-sections stand across the chord and turn about it: sub-conductor i moves along, up and out by Theta (z_i sin,
    -z_i cos, y_i) of the chord's slope. On a level span the slopes are y' and z'.
    """
    cosine, sine = chords(lines)
    up = cosine * direction[..., 1] - sine * direction[..., 0]
    return np.stack([up, direction[..., 2]], axis=-1)


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
