"""How the sub-conductors of free sections stretch beyond their mean. Theory section 12.2.

A sub-conductor that moves along the span by itself has one dynamic tension from end to end, N_i = k (e + h) + k_d J_i,
because longitudinal waves are much faster than galloping. Beyond the mean it is stretched by

    J_i = int dev_i[ (y' + V') (-z_i Theta)' + (z' + W') (y_i Theta)' + ((z_i Theta)'^2 + (y_i Theta)'^2)/2 ] ds/x',
    1/k_d = L_e/EA + 1/K_left + 1/K_right   (K of the yokes; a held one: infinite; if nothing holds an end, k_d = 0),

dashes d/ds, with (y_i, z_i) turned by the static twist. k_d/2 sum_i (J_i^2 - J_i,lin^2) takes the place of the energy
of the local strains of a rigid section. J_i is linear in the position of its sub-conductor and in the square of its
distance from the reference curve, so three stretches serve any number of sub-conductors.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.cross_sections import padded_positions
from engine.spec import CrossSection, Line

NEGLIGIBLE = 1e-12  # of the largest eigenvalue: rounding in the sums over a regular bundle


@dataclass(frozen=True, slots=True)
class TurningSlopes:
    """What stretches are integrated from, at all points of lines.

    translation: (lines, groups, m, 2, points), V' and W' of each coordinate; turning: (lines, groups, m, 2, points),
    (y_i Theta)' and (z_i Theta)' of a sub-conductor one metre above the mean position [m]; curve: (lines, points, 2),
    y' and z' against the normal of the cross-section; weight: (lines, points) = ds/x' [m].
    """

    translation: FloatArray
    turning: FloatArray
    curve: FloatArray
    weight: FloatArray


@dataclass(frozen=True, slots=True)
class OwnStretches:
    """The stretches J of sub-conductors one metre above and beside the mean, and of unit half square of the distance.

    linear: (lines, groups, 3, m) and square: (lines, groups, 3, m, m), J = linear . q + q . square q / 2.
    """

    linear: FloatArray
    square: FloatArray


@dataclass(frozen=True, slots=True)
class TensionForms:
    """Dynamic tensions linear_i . q + q . square_i q / 2 [N]: (lines, groups, n, m) and (lines, groups, n, m, m)."""

    linear: FloatArray
    square: FloatArray


def has_own_tensions(line: Line) -> bool:
    """Tell whether the sub-conductors of a line have tensions of their own."""
    return line.bundle.section is CrossSection.FREE and len(line.bundle.positions) > 1


def own_stretches(at: TurningSlopes) -> OwnStretches:
    """Integrate the stretches J along the span."""
    (v, w), (y_rate, z_rate) = (np.moveaxis(x, -2, 0) for x in (at.translation, at.turning))
    weight = at.weight[:, None, None]
    y, z = at.curve[..., 0][:, None, None], at.curve[..., 1][:, None, None]
    linear = [z * y_rate - y * z_rate, -y * y_rate - z * z_rate, np.zeros_like(y_rate)]
    weighted_y, weighted_z = (np.swapaxes(weight * x, -1, -2) for x in (y_rate, z_rate))
    above = w @ weighted_y - v @ weighted_z
    beside = -(v @ weighted_y + w @ weighted_z)
    distance = y_rate @ weighted_y + z_rate @ weighted_z
    square = np.stack([above, beside, distance], axis=2)
    return OwnStretches(
        np.stack([(x * weight).sum(axis=-1) for x in linear], axis=2), square + np.swapaxes(square, -1, -2)
    )


def shares(lines: Sequence[Line]) -> FloatArray:
    """Return what makes J_i of J: position about the mean and half the deviation of r_i^2, (lines, n, 3) [m, m, m2].

    n is the largest number of sub-conductors; where there are fewer, the mean stands for the others.
    """
    positions, present = padded_positions(lines)
    share = np.append(positions, 0.5 * (positions**2).sum(axis=-1, keepdims=True), axis=-1)
    mean = share.sum(axis=1, keepdims=True) / present.sum(axis=1)[:, None, None]
    return np.where(present[..., None], share - mean, 0.0)


def own_stiffness(lines: Sequence[Line], yoke_stiffness: FloatArray, effective_length: FloatArray) -> FloatArray:
    """Return k_d of lines with given stiffness of both yokes (lines, 2) [N/m] and L_e (lines,) [m]: (lines,) [N/m]."""
    rigidity = np.array([line.conductor.axial_rigidity for line in lines])
    with np.errstate(divide="ignore"):
        give = (1.0 / yoke_stiffness).sum(axis=1)  # infinite where nothing holds an end
    return np.asarray(1.0 / (effective_length / rigidity + give))


def tension_forms(stretches: OwnStretches, force: FloatArray) -> TensionForms:
    """Return sum_c force_ic J_c of each sub-conductor i, force (lines, n, 3) [N/m, N/m, N/m2]."""
    m = stretches.linear.shape[-1]
    linear = force[:, None] @ stretches.linear
    square = force[:, None] @ stretches.square.reshape(*stretches.linear.shape[:-1], m * m)
    return TensionForms(linear, square.reshape(*square.shape[:-1], m, m))


def with_own(mean: TensionForms, own: TensionForms, free: BoolArray) -> TensionForms:
    """Add the own parts (free lines, groups, n, ...) to the mean tension (lines, groups, 1, ...) of all lines."""
    n = own.linear.shape[2]
    linear, square = np.repeat(mean.linear, n, axis=2), np.repeat(mean.square, n, axis=2)
    linear[free] += own.linear
    square[free] += own.square
    return TensionForms(linear, square)


def principal_stretches(stretches: OwnStretches, share: FloatArray) -> tuple[FloatArray, OwnStretches]:
    """Combine stretches to ones whose squares add up to sum_i J_i^2 with weights: (lines, r), r of them a line.

    share: (lines, n, 3) as `shares` returns them. r is the largest rank among the lines: one for twins, two for other
    regular bundles.
    """
    values, vectors = np.linalg.eigh(np.swapaxes(share, -1, -2) @ share)
    rank = int((values > NEGLIGIBLE * values[:, -1:]).sum(axis=1).max(initial=0))
    kept = vectors[..., 3 - rank :]
    linear = np.einsum("lcr,lgcm->lgrm", kept, stretches.linear, optimize=True)
    square = np.einsum("lcr,lgcmk->lgrmk", kept, stretches.square, optimize=True)
    return values[:, 3 - rank :], OwnStretches(linear, square)
