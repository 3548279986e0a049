"""Finite element matrices of the bundle on its reference curve. Theory section 3, paper section 3.

Three-node isoparametric cable elements; four freedoms per node in the order U, V, W, Theta; node-major numbering. The
sub-conductors move by V, W and Theta of the cross-section, eq. (3), so sums over them are formed once and their number
does not add to the cost. Along the span they move by the common U; `free_sections` says what own ones change.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.cross_sections import Sections, bundle_sums, turned_sums
from engine.mechanics.free_sections import Differences, differences
from engine.mechanics.interpolation import StrainPoints, chords, element_nodes, shape_functions, strain_points
from engine.mechanics.static_profile import StaticProfile, arc_position
from engine.spec import GRAVITY, Line, PointDevice

FIELDS = 4
U, V, W, THETA = range(FIELDS)


@dataclass(frozen=True, slots=True)
class Matrices:
    """Stiffness and mass of a stack of lines over all freedoms, and the interpolation they were integrated with.

    stiffness, mass: (lines, freedoms, freedoms), freedoms = 4 (2 elements + 1), symmetric, with end springs but without
    constraints. fixed: (lines, freedoms), True where a support holds the freedom. interpolation:
    (lines, elements, points, 3), values of the element's shape functions at the points of `Sections`; weight:
    (lines, elements, points) = ds of each point [m].
    """

    stiffness: FloatArray
    mass: FloatArray
    fixed: BoolArray
    interpolation: FloatArray
    weight: FloatArray


def matrices(lines: Sequence[Line], profile: StaticProfile, section_points: Sections) -> Matrices:
    """Assemble K and M of theory section 3.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
        Of the same lines.
    section_points : Sections
        Of the same lines, without twist.

    Returns
    -------
    Matrices
    """
    interpolation, weight = mass_points(lines, profile, section_points)
    at = strain_points(lines, profile)
    density = elastic_density(lines, at, bundle_sums(lines)[:, :, None, None])
    element = quadratic_form(at.slopes, at.weight, density)
    element += quadratic_form(interpolation, weight, _ice_stiffness_density(lines, section_points))
    stiffness = assemble(element)
    apart = differences(lines, profile, np.zeros((len(lines), stiffness.shape[-1] // FIELDS)))
    stiffness[:, THETA::FIELDS, THETA::FIELDS] += apart.tangent
    for line, here, values, device in mounted(lines, profile):
        stiffness[line, here, here] += np.kron(np.outer(values, values), device.stiffness())
    add_end_springs(lines, profile, stiffness)
    mass = mass_matrix(lines, profile, section_points, apart)
    return Matrices(stiffness, mass, held_freedoms(profile, mass.shape[-1]), interpolation, weight)


def mass_matrix(
    lines: Sequence[Line],
    profile: StaticProfile,
    section_points: Sections,
    apart: Differences,
    twist: FloatArray | None = None,
) -> FloatArray:
    """Assemble M: (lines, freedoms, freedoms).

    twist: (lines, nodes), static twist of cross-sections and devices [rad], None without. The sections must already be
    turned by it; apart: the differences of sub-conductors at that twist.
    """
    interpolation, weight = mass_points(lines, profile, section_points)
    sums = bundle_sums(lines)[:, :, None, None] if twist is None else turned_sums(lines, section_points.twist)
    mass = assemble(quadratic_form(interpolation, weight, _mass_density(lines, section_points, sums)))
    along = mass[:, U::FIELDS, U::FIELDS] / sums[0, :, :1, :1]  # of one sub-conductor
    mass[:, THETA::FIELDS, THETA::FIELDS] += apart.inertia(along)
    for line, here, values, device in mounted(lines, profile):
        turn = 0.0 if twist is None else float(values @ twist[line, here.start // FIELDS : here.stop // FIELDS])
        mass[line, here, here] += np.kron(np.outer(values, values), device.inertia(turn))
    return mass


def mass_points(
    lines: Sequence[Line], profile: StaticProfile, section_points: Sections
) -> tuple[FloatArray, FloatArray]:
    """Return the shape functions at the points of the sections, (lines, elements, points, 3), and their ds [m]."""
    interpolation, derivative = shape_functions(section_points.local)
    metric = derivative @ element_nodes(profile, lines[0].span.elements)
    return interpolation, section_points.local_weight * np.linalg.norm(metric, axis=-1)


def quadratic_form(values: FloatArray, weight: FloatArray, density: FloatArray) -> FloatArray:
    """Integrate values_a density_ij values_b over each element: (lines, elements, 12, 12)."""
    weighted = values[..., :, None] * weight[..., None, None]
    pairs = np.swapaxes(values[..., None] * weighted.swapaxes(-1, -2), -3, -1)
    flat = pairs.reshape(*pairs.shape[:-3], 9, pairs.shape[-1]) @ density.reshape(*density.shape[:-2], FIELDS**2)
    blocks = flat.reshape(*flat.shape[:-2], 3, 3, FIELDS, FIELDS)
    return np.asarray(blocks.swapaxes(-3, -2).reshape(*flat.shape[:-2], 12, 12))


def elastic_density(lines: Sequence[Line], at: StrainPoints, sums: FloatArray) -> FloatArray:
    """Return D of the strain energy density 1/2 g^T D g, g = (U', V', W', Theta'): (lines, elements, points, 4, 4).

    The strain of sub-conductor i is b.(U', V', W') + (z' y_i - y' z_i) Theta' with b = (x', y', z'), eqs. (3), (7), in
    the second term with y' and z' of `section_slopes`. D is linear in the sums, which are those of `bundle_sums` with
    axes for elements and points.
    """
    n, s_y, s_z, s_yy, s_zz, s_yz = sums
    slopes, tension = at.direction, at.tension
    rigidity = _per_line(lines, [line.conductor.axial_rigidity for line in lines])
    coupling = _per_line(lines, [line.conductor.axial_torsional_coupling for line in lines])
    torsional = _per_line(lines, [line.conductor.torsional_rigidity for line in lines])
    y, z = np.moveaxis(at.section_slopes, -1, 0)
    cosine, sine = chords(lines)
    lever = z * s_y - y * s_z
    density = np.zeros((*tension.shape, FIELDS, FIELDS))
    density[..., :THETA, :THETA] = (n * rigidity)[..., None, None] * slopes[..., :, None] * slopes[..., None, :]
    density[..., :THETA, THETA] = slopes * (rigidity * lever + n * coupling)[..., None]
    density[..., THETA, THETA] = rigidity * (z**2 * s_yy - 2.0 * y * z * s_yz + y**2 * s_zz)
    density[..., THETA, THETA] += 2.0 * coupling * lever + n * torsional + tension * (s_yy + s_zz)
    for translation in (U, V, W):
        density[..., translation, translation] += n * tension
    density[..., U, THETA] += sine * tension * s_z
    density[..., V, THETA] -= cosine * tension * s_z
    density[..., W, THETA] += tension * s_y
    density[..., THETA, :THETA] = density[..., :THETA, THETA]
    return density


def _mass_density(lines: Sequence[Line], section_points: Sections, bundle: FloatArray) -> FloatArray:
    """Return R with kinetic energy density 1/2 (U, V, W, Theta)' R (U, V, W, Theta)'^T, eqs. (A1)-(A4)."""
    n, s_y, s_z, s_yy, s_zz, _ = bundle
    inertia = _per_line(lines, [line.conductor.polar_inertia for line in lines])
    mass, moment_y, moment_z = (
        section_points.mass,
        section_points.first_moment[..., 0],
        section_points.first_moment[..., 1],
    )
    density = np.zeros((*mass.shape, FIELDS, FIELDS))
    for translation in (U, V, W):
        density[..., translation, translation] = n * mass
    cosine, sine = chords(lines)
    density[..., U, THETA] = density[..., THETA, U] = sine * (mass * s_z + n * moment_z)
    density[..., V, THETA] = density[..., THETA, V] = -cosine * (mass * s_z + n * moment_z)
    density[..., W, THETA] = density[..., THETA, W] = mass * s_y + n * moment_y
    density[..., THETA, THETA] = mass * (s_yy + s_zz) + 2.0 * (moment_y * s_y + moment_z * s_z) + n * inertia
    return density


def _ice_stiffness_density(lines: Sequence[Line], section_points: Sections) -> FloatArray:
    """Return the density of K_ice, eq. (A9): eccentric weight above the centre reduces the stiffness of Theta."""
    density = np.zeros((*section_points.mass.shape, FIELDS, FIELDS))
    count = _per_line(lines, [len(line.bundle.positions) for line in lines])
    density[..., THETA, THETA] = -count * GRAVITY * section_points.first_moment[..., 0]
    return density


def _per_line(lines: Sequence[Line], values: Sequence[float]) -> FloatArray:
    return np.array(values, dtype=np.float64).reshape(len(lines), 1, 1)


def assemble(element: FloatArray) -> FloatArray:
    """Assemble element matrices (lines, elements, 12, 12) to (lines, freedoms, freedoms); neighbours share a node."""
    count, elements = element.shape[:2]
    freedoms = FIELDS * (2 * elements + 1)
    total = np.zeros((count, freedoms, freedoms))
    for e in range(elements):
        here = slice(2 * FIELDS * e, 2 * FIELDS * e + 3 * FIELDS)
        total[:, here, here] += element[:, e]
    return total


def held_freedoms(profile: StaticProfile, freedoms: int) -> BoolArray:
    """Tell which freedoms the supports hold: (lines, freedoms)."""
    fixed = np.zeros((profile.arc_length.size, freedoms), dtype=np.bool_)
    fixed[:, [V, W, THETA, -FIELDS + V, -FIELDS + W, -FIELDS + THETA]] = True
    fixed[:, [U, -FIELDS + U]] = np.isinf(profile.end_stiffness)
    return fixed


def add_end_springs(lines: Sequence[Line], profile: StaticProfile, stiffness: FloatArray) -> None:
    """Add the springs that hold U at both ends to K (lines, freedoms, freedoms), in place."""
    count = np.array([len(line.bundle.positions) for line in lines])
    springs = np.where(np.isinf(profile.end_stiffness), 0.0, profile.end_stiffness)
    stiffness[:, U, U] += count * springs[:, 0]
    stiffness[:, -FIELDS + U, -FIELDS + U] += count * springs[:, 1]


def mounted(lines: Sequence[Line], profile: StaticProfile) -> Iterator[tuple[int, slice, FloatArray, PointDevice]]:
    """Yield line, freedoms of the element, shape-function values (3,) and device, for every point device."""
    for i, line in enumerate(lines):
        for point in (point for device in line.devices for point in device.points):
            first, values = interpolation_at(profile, i, line.span.elements, point.position)
            yield i, slice(FIELDS * first, FIELDS * (first + 3)), values, point


def device_damping(lines: Sequence[Line], profile: StaticProfile, shapes: FloatArray) -> FloatArray:
    """Project the damping of devices onto shapes (lines, ..., m, fields, nodes): (lines, ..., m, m).

    fields: the last ones of U, V, W, Theta. Shapes without U omit the damping along the line.
    """
    fields = shapes.shape[-2]
    total = np.zeros((*shapes.shape[:-2], shapes.shape[-3]))
    for line, here, values, device in mounted(lines, profile):
        motion = shapes[line][..., here.start // FIELDS : here.stop // FIELDS] @ values
        total[line] += motion @ np.array(device.damping())[-fields:, -fields:] @ motion.swapaxes(-1, -2)
    return total


def interpolation_at(profile: StaticProfile, line: int, elements: int, position: float) -> tuple[int, FloatArray]:
    """Return first node and shape-function values (3,) of the element that holds a horizontal position [m]."""
    whole = arc_position(profile, np.full((profile.arc_length.size, 1), position))[line, 0]
    scaled = whole / profile.arc_length[line] * elements
    element = min(int(scaled), elements - 1)
    values, _ = shape_functions(np.array(2.0 * (scaled - element) - 1.0))
    return 2 * element, values
