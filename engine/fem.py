"""Finite element matrices of the bundle on its reference curve. Theory section 3, paper section 3.

Three-node isoparametric cable elements; four freedoms a node in the order U, V, W, Theta; node-major numbering. The
rigid cross-section (3) lets the sums over sub-conductors be taken once, so their number costs nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.profile import GRAVITY, StaticProfile, arc_position, coordinates
from engine.sections import Sections, gauss_rule
from engine.spec import AirflowSpoiler, DetuningPendulum, Line, Spacer

FIELDS = 4
U, V, W, THETA = range(FIELDS)
STIFFNESS_POINTS = 2  # three would lock the membrane strain of the curved element


@dataclass(frozen=True, slots=True)
class Matrices:
    """Stiffness and mass of a stack of lines on all freedoms, and the interpolation that made them.

    stiffness, mass: (lines, freedoms, freedoms), freedoms = 4 (2 elements + 1), symmetric; end springs included,
    constraints not. fixed: (lines, freedoms), True where a support holds the freedom. interpolation:
    (lines, elements, points, 3), values of the element's shape functions at the points of `Sections`; weight:
    (lines, elements, points) = ds of each point [m].
    """

    stiffness: FloatArray
    mass: FloatArray
    fixed: BoolArray
    interpolation: FloatArray
    weight: FloatArray


def matrices(lines: Sequence[Line], profile: StaticProfile, made_of: Sections) -> Matrices:
    """Assemble K and M of theory section 3 for lines with the same number of elements.

    Parameters
    ----------
    lines : sequence of Line
    profile : StaticProfile
    made_of : Sections

    Returns
    -------
    Matrices
    """
    elements = lines[0].span.elements
    nodes = _element_nodes(profile, elements)
    bundle = bundle_sums(lines)
    interpolation, derivative = shape_functions(made_of.local)
    weight = made_of.local_weight * np.linalg.norm(_metric(derivative, nodes), axis=-1)
    stiffness = _assemble(_elastic_stiffness(lines, profile, nodes, bundle))
    stiffness += _assemble(_quadratic_form(interpolation, weight, _ice_stiffness_density(lines, made_of)))
    mass = _assemble(_quadratic_form(interpolation, weight, _mass_density(lines, made_of, bundle)))
    _add_devices(lines, profile, stiffness, mass)
    _add_end_springs(lines, profile, stiffness)
    return Matrices(stiffness, mass, _fixed(profile, stiffness.shape[-1]), interpolation, weight)


def shape_functions(local: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return values and local derivatives of the quadratic shape functions, each local.shape + (3,)."""
    values = [0.5 * local * (local - 1.0), 1.0 - local**2, 0.5 * local * (local + 1.0)]
    slopes = [local - 0.5, -2.0 * local, local + 0.5]
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)


def bundle_sums(lines: Sequence[Line]) -> FloatArray:
    """Return n, sum y, sum z, sum y^2, sum z^2 and sum y z over the sub-conductors: (6, lines)."""
    sums = []
    for line in lines:
        y, z = np.array(line.bundle.positions).T
        sums.append((y.size, y.sum(), z.sum(), y @ y, z @ z, y @ z))
    return np.array(sums, dtype=np.float64).T


def _element_nodes(profile: StaticProfile, elements: int) -> FloatArray:
    """Return the node positions of each element, (lines, elements, 3 nodes, 3 co-ordinates)."""
    arc = profile.arc_length[:, None] * np.linspace(0.0, 1.0, 2 * elements + 1)
    first = 2 * np.arange(elements)[:, None] + np.arange(3)
    return coordinates(profile, arc)[:, first]


def _metric(derivative: FloatArray, nodes: FloatArray) -> FloatArray:
    """Return dr/d(local) of the isoparametric curve, (lines, elements, points, 3)."""
    return derivative @ nodes


def _quadratic_form(values: FloatArray, weight: FloatArray, density: FloatArray) -> FloatArray:
    """Integrate values_a density_ij values_b over each element: (lines, elements, 12, 12)."""
    weighted = values[..., :, None] * weight[..., None, None]
    pairs = np.swapaxes(values[..., None] * weighted.swapaxes(-1, -2), -3, -1)
    flat = pairs.reshape(*pairs.shape[:-3], 9, pairs.shape[-1]) @ density.reshape(*density.shape[:-2], FIELDS**2)
    blocks = flat.reshape(*flat.shape[:-2], 3, 3, FIELDS, FIELDS)
    return np.asarray(blocks.swapaxes(-3, -2).reshape(*flat.shape[:-2], 12, 12))


def _elastic_stiffness(
    lines: Sequence[Line], profile: StaticProfile, nodes: FloatArray, bundle: FloatArray
) -> FloatArray:
    abscissae, weights = gauss_rule(STIFFNESS_POINTS)
    _, derivative = shape_functions(abscissae)
    metric = _metric(derivative, nodes)
    jacobian = np.linalg.norm(metric, axis=-1)
    slopes = metric / jacobian[..., None]
    tension = profile.horizontal_tension[:, None, None] / slopes[..., 0]
    density = _elastic_density(lines, slopes, tension, bundle)
    return _quadratic_form(derivative / jacobian[..., None], weights * jacobian, density)


def _elastic_density(lines: Sequence[Line], slopes: FloatArray, tension: FloatArray, bundle: FloatArray) -> FloatArray:
    """Return D with density (U', V', W', Theta') D (U', V', W', Theta')^T: (lines, elements, points, 4, 4).

    The strain of sub-conductor i is b.(U', V', W') + (z' y_i - y' z_i) Theta' with b = (x', y', z'), eqs. (3), (7).
    """
    n, s_y, s_z, s_yy, s_zz, s_yz = bundle[:, :, None, None]
    rigidity = _per_line(lines, [line.conductor.axial_rigidity for line in lines])
    coupling = _per_line(lines, [line.conductor.axial_torsional_coupling for line in lines])
    torsional = _per_line(lines, [line.conductor.torsional_rigidity for line in lines])
    y, z = slopes[..., 1], slopes[..., 2]
    lever = z * s_y - y * s_z
    density = np.zeros((*tension.shape, FIELDS, FIELDS))
    density[..., :THETA, :THETA] = (n * rigidity)[..., None, None] * slopes[..., :, None] * slopes[..., None, :]
    density[..., :THETA, THETA] = slopes * (rigidity * lever + n * coupling)[..., None]
    density[..., THETA, THETA] = rigidity * (z**2 * s_yy - 2.0 * y * z * s_yz + y**2 * s_zz)
    density[..., THETA, THETA] += 2.0 * coupling * lever + n * torsional + tension * (s_yy + s_zz)
    for translation in (U, V, W):
        density[..., translation, translation] += n * tension
    density[..., V, THETA] -= tension * s_z
    density[..., W, THETA] += tension * s_y
    density[..., THETA, :THETA] = density[..., :THETA, THETA]
    return density


def _mass_density(lines: Sequence[Line], made_of: Sections, bundle: FloatArray) -> FloatArray:
    """Return R with kinetic energy density 1/2 (U, V, W, Theta)' R (U, V, W, Theta)'^T, eqs. (A1)-(A4)."""
    n, s_y, s_z, s_yy, s_zz, _ = bundle[:, :, None, None]
    inertia = _per_line(lines, [line.conductor.polar_inertia for line in lines])
    mass, moment_y, moment_z = made_of.mass, made_of.first_moment[..., 0], made_of.first_moment[..., 1]
    density = np.zeros((*mass.shape, FIELDS, FIELDS))
    for translation in (U, V, W):
        density[..., translation, translation] = n * mass
    density[..., V, THETA] = density[..., THETA, V] = -(mass * s_z + n * moment_z)
    density[..., W, THETA] = density[..., THETA, W] = mass * s_y + n * moment_y
    density[..., THETA, THETA] = mass * (s_yy + s_zz) + 2.0 * (moment_y * s_y + moment_z * s_z) + n * inertia
    return density


def _ice_stiffness_density(lines: Sequence[Line], made_of: Sections) -> FloatArray:
    """Return the density of K_ice, eq. (A9): the eccentric weight above the centre takes stiffness from Theta."""
    density = np.zeros((*made_of.mass.shape, FIELDS, FIELDS))
    count = _per_line(lines, [len(line.bundle.positions) for line in lines])
    density[..., THETA, THETA] = -count * GRAVITY * made_of.first_moment[..., 0]
    return density


def _per_line(lines: Sequence[Line], values: Sequence[float]) -> FloatArray:
    return np.array(values, dtype=np.float64).reshape(len(lines), 1, 1)


def _assemble(element: FloatArray) -> FloatArray:
    """Add element matrices (lines, elements, 12, 12) to (lines, freedoms, freedoms); neighbours share one node."""
    count, elements = element.shape[:2]
    freedoms = FIELDS * (2 * elements + 1)
    total = np.zeros((count, freedoms, freedoms))
    for e in range(elements):
        here = slice(2 * FIELDS * e, 2 * FIELDS * e + 3 * FIELDS)
        total[:, here, here] += element[:, e]
    return total


def _fixed(profile: StaticProfile, freedoms: int) -> BoolArray:
    fixed = np.zeros((profile.arc_length.size, freedoms), dtype=np.bool_)
    fixed[:, [V, W, THETA, -FIELDS + V, -FIELDS + W, -FIELDS + THETA]] = True
    fixed[:, [U, -FIELDS + U]] = np.isinf(profile.end_stiffness)
    return fixed


def _add_end_springs(lines: Sequence[Line], profile: StaticProfile, stiffness: FloatArray) -> None:
    count = np.array([len(line.bundle.positions) for line in lines])
    springs = np.where(np.isinf(profile.end_stiffness), 0.0, profile.end_stiffness)
    stiffness[:, U, U] += count * springs[:, 0]
    stiffness[:, -FIELDS + U, -FIELDS + U] += count * springs[:, 1]


def _add_devices(lines: Sequence[Line], profile: StaticProfile, stiffness: FloatArray, mass: FloatArray) -> None:
    for i, line in enumerate(lines):
        for device in line.devices:
            if isinstance(device, AirflowSpoiler):
                continue
            first, values = interpolation_at(profile, i, line.span.elements, device.position)
            here = slice(FIELDS * first, FIELDS * (first + 3))
            inertia, gravity = _device_inertia(device)
            pairs = np.outer(values, values)
            mass[i, here, here] += np.kron(pairs, inertia)
            stiffness[i, here, here] += np.kron(pairs, np.diag([0.0, 0.0, 0.0, gravity]))


def interpolation_at(profile: StaticProfile, line: int, elements: int, position: float) -> tuple[int, FloatArray]:
    """Return the first node and the shape-function values (3,) of the element at a horizontal position [m]."""
    whole = arc_position(profile, np.full((profile.arc_length.size, 1), position))[line, 0]
    scaled = whole / profile.arc_length[line] * elements
    element = min(int(scaled), elements - 1)
    values, _ = shape_functions(np.array(2.0 * (scaled - element) - 1.0))
    return 2 * element, values


def _device_inertia(device: Spacer | DetuningPendulum) -> tuple[FloatArray, float]:
    """Return the 4 x 4 inertia of a device on (U, V, W, Theta) and its gravity stiffness on Theta [N m]."""
    inertia = np.diag([device.mass] * FIELDS)
    if isinstance(device, Spacer):
        inertia[THETA, THETA] = device.polar_inertia
        return inertia, 0.0
    y, z = -device.arm * np.cos(device.angle), device.arm * np.sin(device.angle)
    inertia[THETA, THETA] = device.mass * device.arm**2
    inertia[V, THETA] = inertia[THETA, V] = -device.mass * z
    inertia[W, THETA] = inertia[THETA, W] = device.mass * y
    return inertia, float(-device.mass * GRAVITY * y)
