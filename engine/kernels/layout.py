"""How stacks of models are laid out as arguments of the kernels: Model and Unexpanded of engine/kernels/kernels.h."""

from typing import TYPE_CHECKING

import numpy as np

from engine.arrays import AnyArray

if TYPE_CHECKING:  # kernels stand below the models, whose arrays they read
    from engine.models.reduced_model import ReducedModel
    from engine.models.unexpanded_load import UnexpandedLoad


def model_shape(model: "ReducedModel") -> tuple[int, int, int, int, bool, int]:
    """Return members, coordinates, points, local variables, whether the model stretches, and samples in a period.

    An unexpanded load has sub-conductors in place of local variables; otherwise the number of samples is 0.
    """
    load, m = model.unexpanded, model.mass.shape[-1]
    members, stretches = model.mass.shape[0], model.stretching is not None
    if load is not None:
        return members, m, load.fields.shape[-3], load.present.shape[-1], stretches, load.samples
    return members, m, *model.load.forms.shape[1:3], stretches, 0


def model_parts(model: "ReducedModel") -> tuple[AnyArray, ...]:
    """Return the arrays of a stack of models; those of stretching are empty where it is neglected."""
    load, stretching, none = model.load, model.stretching, np.empty(0)
    own = (none, none) if stretching is None else (stretching.table, stretching.slopes)
    parity = np.zeros(model.mass.shape[:-1], dtype=np.intp) if model.parity is None else model.parity
    structure = (model.mass, model.damping, model.stiffness, *own, parity)
    if model.unexpanded is not None:
        return (*contiguous(*structure), *unexpanded_parts(model.unexpanded))
    return contiguous(*structure, load.forms, load.table, load.slopes)


def unexpanded_parts(load: "UnexpandedLoad") -> tuple[AnyArray, ...]:
    """Return the arrays of a stack of unexpanded loads."""
    curves = load.curves
    first, begins = curves.pieces
    return contiguous(
        load.which,
        first,
        curves.periodic.astype(np.intp),
        curves.turning.astype(np.intp),
        load.fields,
        load.strength,
        load.factor,
        load.diameter,
        load.positions,
        load.present,
        load.rest_angle,
        load.at_rest,
        curves.origin,
        curves.density,
        begins,
        curves.knots,
        curves.powers,
    )


def contiguous(*arrays: AnyArray) -> tuple[AnyArray, ...]:
    """Return the arrays in C order, copied where they are not."""
    return tuple(np.ascontiguousarray(array) for array in arrays)
