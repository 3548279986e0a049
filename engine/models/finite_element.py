"""The finite element model: several modes per direction, with the exact load. Theory section 7.4."""

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.mechanics.finite_elements import FIELDS, THETA, U, V, W, device_damping
from engine.mechanics.modes import DirectionalShapes, FullModes, at_points
from engine.models.aerodynamic_load import PolynomialLoad, cheapest_load, no_load, span_angles, span_load, take_load
from engine.models.discretization import Discretization, fields_in_space
from engine.models.reduced_model import ReducedModel, damping_ratios, diagonal_matrices
from engine.models.relief import DAMPING_RATIO, relief_displacement
from engine.models.stretching import stretching_of, take_stretching
from engine.models.unexpanded_load import load_as_it_stands, take_unexpanded
from engine.spec import Analysis, DampingModel, Stretching

TRANSVERSE = (V, W, THETA)


def finite_element_model(
    discretization: Discretization,
    modes: FullModes,
    shapes: DirectionalShapes,
    analysis: Analysis,
    *,
    whole: bool = True,
) -> ReducedModel:
    """Return the model reduced to the full modes of several loops per direction, with the exact load: (lines,).

    Where the analysis includes it, with stretching, whose tension the symmetric vertical modes relieve. Without the
    modes of one loop a relief coordinate follows as the last one, as in the hybrid model.

    Damping is that of eq. (11) in the directional modes: C = sum over directions and loops of
    2 zeta omega (M psi)(M psi)^T / (psi^T M psi) with the directional shapes psi, and that of devices. Section 7.4.

    whole: False leaves out what the linear equations of a model whose load stands do not hold.
    """
    modal = modes.vectors.reshape(modes.vectors.shape[0], -1, modes.vectors.shape[-1])
    values = modes.eigenvalues.reshape(modal.shape[:2])
    included = analysis.stretching is Stretching.INCLUDED
    relieves = included and 1 not in modes.loops
    vectors = np.append(modal, relief_displacement(discretization)[:, None], axis=1) if relieves else modal
    in_plane = vectors.reshape(*vectors.shape[:2], -1, FIELDS).swapaxes(-1, -2)
    fields = fields_in_space(discretization.profile, in_plane).copy()
    moving = fields[:, :, list(TRANSVERSE)]
    fields[:, values.shape[1] :] = 0.0  # the wind does not act on the relief coordinate, and nobody sees it
    nodal = fields[:, :, list(TRANSVERSE)]
    at = at_points(discretization.matrices, nodal)
    stretching = stretching_of(discretization, moving[:, None]) if included and whole else None
    mass, stiffness = _projected(discretization, vectors) if relieves else _diagonal(values)
    damping = _modal_damping(discretization, modal, shapes, modes.loops)
    return ReducedModel(
        mass=mass,
        damping=(_with_damped_relief(damping, mass, stiffness) if relieves else damping)
        + device_damping(discretization.lines, discretization.profile, fields),
        stiffness=stiffness,
        load=_load(discretization, at, analysis) if whole else no_load(mass.shape),
        shapes=nodal,
        direction=np.resize(np.repeat(np.arange(3), len(modes.loops)), fields.shape[1]),  # relief: vertical
        statically_unstable=_unstable(values, shapes),
        stretching=take_stretching(stretching, (slice(None), 0)),
        unexpanded=take_unexpanded(load_as_it_stands(discretization, at[:, None], analysis), (slice(None), 0)),
    )


def _load(discretization: Discretization, at: FloatArray, analysis: Analysis) -> PolynomialLoad:
    if analysis.load_stands:  # nothing but the angle of attack is read
        angle = span_angles(discretization.lines, discretization.sections, at[:, None])
        return no_load((*at.shape[:2], at.shape[1]), angle[:, 0])
    load = span_load(
        discretization.lines,
        discretization.sections,
        discretization.matrices.weight,
        at[:, None],
        analysis.aerodynamic_model,
    )
    return take_load(cheapest_load(load), (slice(None), 0))


def _unstable(values: FloatArray, shapes: DirectionalShapes) -> BoolArray:
    return np.asarray((values <= 0.0).any(axis=-1) | np.isnan(shapes.angular_frequency).any(axis=(1, 2)))


def _diagonal(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return M and K of modes with unit modal mass and eigenvalues (lines, m)."""
    return np.broadcast_to(np.eye(values.shape[1]), (*values.shape, values.shape[1])), diagonal_matrices(values)


def _projected(discretization: Discretization, vectors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Project M and K onto displacements (lines, m, freedoms)."""
    system, back = discretization.matrices, vectors.swapaxes(-1, -2)
    return vectors @ system.mass @ back, vectors @ system.stiffness @ back


def _with_damped_relief(damping: FloatArray, mass: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Append the damping of the relief coordinate, which is the last one of M and K."""
    whole = np.zeros(mass.shape)
    whole[:, :-1, :-1] = damping
    whole[:, -1, -1] = 2.0 * DAMPING_RATIO * np.sqrt(stiffness[:, -1, -1] * mass[:, -1, -1])
    return whole


def _modal_damping(
    discretization: Discretization, vectors: FloatArray, shapes: DirectionalShapes, loops: tuple[int, ...]
) -> FloatArray:
    constant = np.array([line.damping.model is DampingModel.CONSTANT_COEFFICIENT for line in discretization.lines])
    selected = [shapes.loops.index(k) for k in loops]
    own, first = shapes.angular_frequency[:, selected], shapes.angular_frequency[:, [shapes.loops.index(1)]]
    rate = (
        2.0
        * damping_ratios(discretization.lines)[:, None]
        * np.nan_to_num(np.where(constant[:, None, None], first, own))
    )
    damping = np.zeros((*vectors.shape[:2], vectors.shape[1]))
    for i, own_fields in enumerate(((U, V), (W,), (THETA,))):
        # Only the mass of the direction itself: momentum coupled into it by eccentric ice is not damped.
        own_field = np.isin(np.arange(vectors.shape[-1]) % FIELDS, own_fields)
        mass = discretization.matrices.mass * (own_field[:, None] & own_field)
        psi = np.swapaxes(shapes.nodal[:, selected], -1, -2).reshape(vectors.shape[0], len(loops), -1) * own_field
        momentum = psi @ mass
        own_mass = np.einsum("lkf,lkf->lk", momentum, psi)
        share = vectors @ momentum.swapaxes(-1, -2)
        damping += (share * (rate[..., i] / own_mass)[:, None, :]) @ share.swapaxes(-1, -2)
    return damping
