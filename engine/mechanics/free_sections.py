"""Free sections: every sub-conductor may move along the span by itself. Theory section 12.2.

V, W and Theta stay common, eq. (3); U becomes the mean of the sub-conductors' own U_i. Let u_i = U_i - U, and let
(eta_i, zeta_i) be the position of sub-conductor i about the mean position, turned by Theta. The differences store

    1/2 sum_i int EA (x' u_i' + l_i Theta')^2 + T u_i'^2 ds + springs on u_i at both ends,   l_i = z' eta_i - y' zeta_i,

with y' and z' of `section_slopes`, and nothing else: sum_i u_i = sum_i l_i = 0, so their products with the mean strain
and with B_T vanish. A rigid section has u_i = 0. Static condensation makes u_i a linear form of the position of
sub-conductor i. So two scalar fields, with the shape functions of U, serve any number of sub-conductors: u_i of the
positions (1, 0) and (0, 1).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray
from engine.mechanics.cross_sections import padded_positions
from engine.mechanics.interpolation import StrainPoints, strain_points
from engine.mechanics.static_profile import StaticProfile
from engine.spec import CrossSection, Line


@dataclass(frozen=True, slots=True)
class Differences:
    """What the sub-conductors' own motion along the span changes; zero for rigid sections.

    gradient: (lines, nodes) [N m] and tangent: (lines, nodes, nodes) [N m], first and second derivative by the twist of
    the nodes of the strain energy less that of a rigid section. motion: (lines, 2, nodes, nodes) [-], derivative by the
    twist of u_i of a sub-conductor one metre above, or beside, the mean position; moments: (lines, 2, 2) [m2], sums of
    (y, z)(y, z)^T about the mean position.
    """

    gradient: FloatArray
    tangent: FloatArray
    motion: FloatArray
    moments: FloatArray

    def inertia(self, mass: FloatArray) -> FloatArray:
        """Return what the motion adds to the mass matrix of Theta, given that of U of one sub-conductor."""
        return np.asarray(
            np.einsum("lij,lina,lnm,ljmb->lab", self.moments, self.motion, mass, self.motion, optimize=True)
        )


def differences(lines: Sequence[Line], profile: StaticProfile, twist: FloatArray) -> Differences:
    """Condense the differences of sub-conductors at a given twist of the nodes.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
        Of the same lines.
    twist : (lines, nodes)
        Theta [rad], of any size.

    Returns
    -------
    Differences
    """
    nodes = twist.shape[1]
    moments = second_moments(lines)
    if not moments.any():
        none = np.zeros((len(lines), 2, nodes, nodes))
        return Differences(none[:, 0, 0], none[:, 0], none, moments)
    at = strain_points(lines, profile)
    slopes, values = _readers(at)
    rate = slopes @ twist[..., None]
    lever, turned = _levers(at, (values @ twist[..., None])[..., 0])
    strain = lever * slopes[:, None] + turned * rate[:, None] * values
    pull = slopes.swapaxes(-1, -2) * (_rigidity(lines) * _flat(at.weight * at.direction[..., 0]))[:, None]
    follow = -_flexibility(lines, profile, at, slopes, values) @ pull
    motion = follow[:, None] @ strain
    tension = np.einsum("lij,lnp,lnq,ljq->lip", moments, pull, follow, (lever * rate[:, None])[..., 0], optimize=True)
    mixed = slopes.swapaxes(-1, -2) @ ((tension[..., None] * turned).sum(axis=1) * values)
    bent = values.T @ ((tension[..., None] * lever).sum(axis=1) * rate * values)
    return Differences(
        gradient=np.einsum("lip,lipn->ln", tension, strain),
        tangent=np.einsum("lij,lnp,lipa,ljnb->lab", moments, pull, strain, motion, optimize=True)
        + (mixed + mixed.swapaxes(-1, -2) - bent),
        motion=motion,
        moments=moments,
    )


def second_moments(lines: Sequence[Line]) -> FloatArray:
    """Return the sums of (y, z)(y, z)^T about the mean position, (lines, 2, 2) [m2]; zero for rigid sections."""
    positions, present = padded_positions(lines)
    mean = positions.sum(axis=1, keepdims=True) / present.sum(axis=1)[:, None, None]
    free = np.array([line.bundle.section is CrossSection.FREE for line in lines])
    about_mean = np.where(present[..., None] & free[:, None, None], positions - mean, 0.0)
    return np.asarray(about_mean.swapaxes(-1, -2) @ about_mean)


def _rigidity(lines: Sequence[Line]) -> FloatArray:
    return np.array([[line.conductor.axial_rigidity] for line in lines])


def _flat(values: FloatArray) -> FloatArray:
    """Join the axes of elements and points: (lines, all points)."""
    return values.reshape(values.shape[0], -1)


def _readers(at: StrainPoints) -> tuple[FloatArray, FloatArray]:
    """Return the matrices that read slopes (lines, points, nodes) and values (points, nodes) at all strain points."""
    lines, elements, points = at.weight.shape
    slopes, values = (
        np.zeros((lines, elements, points, 2 * elements + 1)),
        np.zeros((elements, points, 2 * elements + 1)),
    )
    for e in range(elements):
        here = slice(2 * e, 2 * e + 3)
        slopes[:, e, :, here], values[e, :, here] = at.slopes[:, e], at.values
    return slopes.reshape(lines, elements * points, -1), values.reshape(elements * points, -1)


def _levers(at: StrainPoints, turn: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return l_i of the positions (1, 0) and (0, 1), and its derivative by the turn: (lines, 2, points, 1)."""
    y, z = _flat(at.section_slopes[..., 0]), _flat(at.section_slopes[..., 1])
    c, s = np.cos(turn), np.sin(turn)
    above, beside = z * c - y * s, -z * s - y * c
    return np.stack([above, beside], axis=1)[..., None], np.stack([beside, -above], axis=1)[..., None]


def _flexibility(
    lines: Sequence[Line], profile: StaticProfile, at: StrainPoints, slopes: FloatArray, values: FloatArray
) -> FloatArray:
    """Return the inverse of the stiffness of a field u_i: (lines, nodes, nodes) [m/N], zero where a yoke holds it.

    slopes, values: as `_readers` returns them. If nothing holds the field at either end, its mean is zero.
    """
    weight = _flat(at.weight)
    rigidity = _rigidity(lines) * _flat(at.direction[..., 0]) ** 2 + _flat(at.tension)
    stiffness = slopes.swapaxes(-1, -2) @ ((rigidity * weight)[..., None] * slopes)
    held = np.isinf(profile.yoke_stiffness)
    stiffness[:, [0, -1], [0, -1]] += np.where(held, 0.0, profile.yoke_stiffness)
    loose = np.where((profile.yoke_stiffness == 0.0).all(axis=1), rigidity[:, 0] / weight.sum(axis=1) ** 3, 0.0)
    mean = weight @ values
    stiffness += loose[:, None, None] * mean[..., None] * mean[:, None]
    free = np.ones(mean.shape)
    free[:, [0, -1]] = ~held
    moving = free[..., None] * free[:, None]
    return np.asarray(np.linalg.inv(stiffness * moving + (1.0 - free)[..., None] * np.eye(mean.shape[1])) * moving)
