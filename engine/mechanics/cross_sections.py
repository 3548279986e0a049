"""Mass, ice, wind and aerodynamics along a span, at the quadrature points of each element, and sums over bundles.

Ice, spoilers and the wind profile change at given positions. Every integral is taken piece by piece between those
positions, so a boundary inside an element causes no quadrature error (theory section 3).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.along_span import boundaries, coefficients_along, wind_factor
from engine.mechanics.coefficients import fit_measured
from engine.mechanics.static_profile import StaticProfile, arc_position, horizontal_position
from engine.spec import Aerodynamics, Line, ice_properties

PIECE_POINTS = 5  # exact to degree 9: cubic loads of quadratic shapes, times a shape
FEWER_POINTS = 4  # for loads that are no polynomials: five leave 1e-7 of the amplitudes as well


@dataclass(frozen=True, slots=True)
class Sections:
    """Properties at the quadrature points of each element, shape (lines, elements, points) unless said otherwise.

    local is the element coordinate in [-1, 1] and local_weight its quadrature weight (0 on padding);
    mass [kg/m] and first_moment (..., 2) = m (e_y, e_z) [kg] of a sub-conductor; wind_factor phi;
    aerodynamics (..., 3, 4): rows vertical, horizontal, torsional, columns a_i0 to a_i3 of a sub-conductor.
    fitted_range (lines,): the smallest range of the fits on the line [rad], infinite where none is known; twist: the
    static twist already applied to moments and coefficients [rad].
    """

    local: FloatArray
    local_weight: FloatArray
    mass: FloatArray
    first_moment: FloatArray
    wind_factor: FloatArray
    aerodynamics: FloatArray
    fitted_range: FloatArray
    twist: FloatArray


def sections(lines: Sequence[Line], profile: StaticProfile, points: int = PIECE_POINTS) -> Sections:
    """Place quadrature points between all boundaries of each line and evaluate the properties there.

    Parameters
    ----------
    lines : sequence of Line
        All with the same number of elements.
    profile : StaticProfile
        Of the same lines.
    points : int
        Of the piece of an element between two boundaries.

    Returns
    -------
    Sections
    """
    elements = lines[0].span.elements
    edges = _piece_edges(lines, profile, elements)
    abscissae, weights = gauss_rule(points)
    width = np.diff(edges, axis=-1)[..., None]
    local = edges[..., :-1, None] + 0.5 * width * (abscissae + 1.0)
    shape = (len(lines), elements, -1)
    local = local.reshape(shape)
    position = positions(profile, local)
    values = [_line_properties(line, x) for line, x in zip(lines, position, strict=True)]
    return Sections(
        local=local,
        local_weight=np.broadcast_to(0.5 * width * weights, (*width.shape[:-1], points)).reshape(shape),
        mass=np.stack([v[0] for v in values]),
        first_moment=np.stack([v[1] for v in values]),
        wind_factor=np.stack([v[2] for v in values]),
        aerodynamics=np.stack([v[3] for v in values]),
        fitted_range=np.array([_fitted_range(line) for line in lines]),
        twist=np.zeros(local.shape),
    )


def turned(lines: Sequence[Line], profile: StaticProfile, section_points: Sections, twist: FloatArray) -> Sections:
    """Apply a static twist: rotate the first moments, and fit tabulated coefficients at the local angle.

    Parameters
    ----------
    lines : sequence of Line
    profile : StaticProfile
    section_points : Sections
        Without twist.
    twist : (lines, elements, points)
        Static twist [rad].

    Returns
    -------
    Sections

    Raises
    ------
    InvalidSpec
        If a table of coefficients has too few rows around the local angle.
    """
    position = positions(profile, section_points.local)
    stack = zip(lines, position, twist, strict=True)
    return replace(
        turned_moments(section_points, twist),
        aerodynamics=np.stack([_aerodynamics(line, x, turn) for line, x, turn in stack]),
    )


def turned_moments(section_points: Sections, twist: FloatArray) -> Sections:
    """Rotate the first moments of untwisted sections by a twist [rad]; the coefficients stay as they are."""
    moment_y, moment_z = section_points.first_moment[..., 0], section_points.first_moment[..., 1]
    c, s = np.cos(twist), np.sin(twist)
    moment = np.stack([moment_y * c - moment_z * s, moment_y * s + moment_z * c], axis=-1)
    return replace(section_points, first_moment=moment, twist=twist)


def positions(profile: StaticProfile, local: FloatArray) -> FloatArray:
    """Return the horizontal positions [m] of points given by their element coordinates."""
    elements = local.shape[1]
    arc = (np.arange(elements)[:, None] + 0.5 * (local + 1.0)) * (profile.arc_length[:, None, None] / elements)
    return horizontal_position(profile, arc)


def padded_positions(lines: Sequence[Line]) -> tuple[FloatArray, BoolArray]:
    """Return (y, z) of the sub-conductors, (lines, n, 2) [m], zero beyond those of a line, and which it has."""
    each = [line.bundle.positions for line in lines]
    count = np.array([len(positions) for positions in each])
    most = int(count.max())
    padded = [(*positions, *((0.0, 0.0),) * (most - len(positions))) for positions in each]
    return np.array(padded, dtype=np.float64), np.arange(most) < count[:, None]


def bundle_sums(lines: Sequence[Line]) -> FloatArray:
    """Return n, sum y, sum z, sum y^2, sum z^2 and sum y z over the sub-conductors: (6, lines)."""
    positions, present = padded_positions(lines)
    y, z = np.moveaxis(positions, -1, 0)
    return np.stack([values.sum(axis=-1) for values in (present, y, z, y**2, z**2, y * z)])


def turned_sums(lines: Sequence[Line], angle: FloatArray) -> FloatArray:
    """Return `bundle_sums` of cross-sections turned by angles (lines, elements, points) [rad]: (6, ...)."""
    n, s_y, s_z, s_yy, s_zz, s_yz = bundle_sums(lines)[:, :, None, None]
    c, s = np.cos(angle), np.sin(angle)
    one = np.ones_like(angle)
    y_y = c**2 * s_yy - 2.0 * c * s * s_yz + s**2 * s_zz
    y_z = c * s * (s_yy - s_zz) + (c**2 - s**2) * s_yz
    return np.stack([n * one, c * s_y - s * s_z, s * s_y + c * s_z, y_y, s_yy + s_zz - y_y, y_z])


@lru_cache
def gauss_rule(points: int) -> tuple[FloatArray, FloatArray]:
    """Return abscissae and weights of Gauss-Legendre quadrature on [-1, 1]."""
    abscissae, weights = np.polynomial.legendre.leggauss(points)
    return abscissae, weights


def _piece_edges(lines: Sequence[Line], profile: StaticProfile, elements: int) -> FloatArray:
    """Return the element coordinates of piece boundaries, (lines, elements, pieces + 1), padded with empty pieces."""
    marks = [np.array(boundaries(line)) for line in lines]
    most = max(m.size for m in marks)
    padded = np.stack([np.append(m, [x.span.length] * (most - m.size)) for m, x in zip(marks, lines, strict=True)])
    scaled = arc_position(profile, padded) * (elements / profile.arc_length[:, None])
    local = np.clip(2.0 * (scaled[:, None, :] - np.arange(elements)[:, None]) - 1.0, -1.0, 1.0)
    inside = (np.abs(local) < 1.0).sum(axis=-1).max(initial=0)
    ends = np.full((len(lines), elements, 1), 1.0)
    # A mark outside an element was clipped to one of its ends: those pieces are empty, and the surplus is dropped.
    inner = np.sort(np.where(np.abs(local) < 1.0, local, 1.0), axis=-1)[..., :inside]
    return np.concatenate([-ends, inner, ends], axis=-1)


def _line_properties(line: Line, position: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    e_y, e_z, base = ice_properties(line, line.ice)
    mass = np.full(position.shape, base)
    moment = np.broadcast_to(base * np.array([e_y, e_z]), (*position.shape, 2)).copy()
    for segment in line.ice.segments:
        here = (position >= segment.start) & (position < segment.stop)
        e_y, e_z, iced = ice_properties(line, segment)
        mass[here] = iced
        moment[here] = iced * np.array([e_y, e_z])
    for part in line.stretches:
        mass[(position >= part.start) & (position < part.stop)] += part.mass
    return mass, moment, wind_factor(line, position), _aerodynamics(line, position, np.zeros(position.shape))


def _aerodynamics(line: Line, position: FloatArray, twist: FloatArray) -> FloatArray:
    """Return the coefficients at positions [m], of a device, else of an ice segment, else of the span: (..., 3, 4)."""
    result = np.empty((*position.shape, 3, 4))
    for start, stop, aerodynamics in coefficients_along(line):
        here = (position >= start) & (position < stop)
        result[here] = _at_local_angle(aerodynamics, twist[here])
    return result


def _at_local_angle(aerodynamics: Aerodynamics, twist: FloatArray) -> FloatArray:
    """Return the coefficients at points with a twist [rad]; without a table the twist does not change them."""
    if aerodynamics.measured is None or not twist.any():
        return _table(aerodynamics)
    return np.stack([_table(fit_measured(aerodynamics.measured, turn)) for turn in twist.tolist()])


def _table(aerodynamics: Aerodynamics) -> FloatArray:
    at_rest = aerodynamics.at_rest or (0.0, 0.0, 0.0)
    rows = (aerodynamics.vertical, aerodynamics.horizontal, aerodynamics.torsional)
    return np.array([(a_0, *row) for a_0, row in zip(at_rest, rows, strict=True)])


def _fitted_range(line: Line) -> float:
    ranges = [aerodynamics.fitted_range for _, _, aerodynamics in coefficients_along(line)]
    return min((r for r in ranges if r is not None), default=np.inf)
