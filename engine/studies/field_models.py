"""Reduced models as functions of a field of the line, by polynomial interpolation.

A model is a smooth function of lengths, tensions, damping ratios and so on. Its range is divided into panels; nine
values per panel define the polynomial, and values between them check it. A panel in which the check fails is halved.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields
from math import prod

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.models.aerodynamic_load import PolynomialLoad
from engine.models.reduced_model import ReducedModel, take
from engine.models.stretching import StretchingForce

NODES = 9  # values per panel
HALVINGS = 6
ACCURACY = 1e-9  # relative error of each part of the model between the values
SMALLEST = 1e-6  # of the largest number of an array: smallest scale of its errors
CHECKED = (-0.93, 0.11, 0.76)  # places in a panel, from -1 to 1, at which the polynomial is checked

ModelsOf = Callable[[FloatArray], ReducedModel | None]
"""Returns the models at values, leading axes (values, columns), or None if one of the values has no line."""

_NODES = np.cos(np.pi * np.arange(NODES) / (NODES - 1))
_WEIGHTS = np.where(np.arange(NODES) % 2 == 0, 1.0, -1.0) * np.where(np.isin(np.arange(NODES), (0, NODES - 1)), 0.5, 1)


@dataclass(frozen=True, slots=True)
class FieldModels:
    """Models over a range of values of a field.

    template: one model per column, for what does not vary; low, high: (panels,), ends of the panels in rising
    order; parts: (panels, nodes, columns, numbers), all numbers of the models at the nodes; defined: (panels, columns).
    """

    template: ReducedModel
    low: FloatArray
    high: FloatArray
    parts: FloatArray
    defined: BoolArray

    def at(self, values: FloatArray, column: IntArray) -> tuple[ReducedModel, BoolArray]:
        """Return the models at values (k,) in columns (k,), and which of them exist.

        Beyond the range the polynomials of the outer panels are extrapolated.
        """
        panel = np.clip(np.searchsorted(self.high, values), 0, self.high.size - 1)
        place = (2.0 * values - self.low[panel] - self.high[panel]) / (self.high[panel] - self.low[panel])
        numbers = np.einsum("kn,knx->kx", _lagrange(place), self.parts[panel, :, column])
        return _from_rows(take(self.template, column), numbers), self.defined[panel, column] & np.isfinite(values)


def field_models(models_of: ModelsOf, low: float, high: float) -> FieldModels:
    """Return the models over a range of values.

    Parameters
    ----------
    models_of : callable
    low, high : float
        Ends of the range, which must both have a line.

    Returns
    -------
    FieldModels
    """
    template = models_of(np.array([low, high]))
    if template is None:
        raise ValueError("the field has no line at an end of its range")
    panels: list[tuple[float, float, FloatArray, BoolArray]] = []
    pending = [(low, high, HALVINGS)]
    while pending:
        left, right, halvings = pending.pop()
        numbers, good = _panel(models_of, left, right)
        if numbers is not None and (good.all() or halvings == 0):
            panels.append((left, right, numbers, good))
        elif halvings == 0:
            columns = template.mass.shape[1]
            nothing = np.tile(_to_rows(take(template, 0))[None], (NODES, 1, 1))
            panels.append((left, right, nothing, np.zeros(columns, dtype=np.bool_)))
        else:
            middle = 0.5 * (left + right)
            pending += [(middle, right, halvings - 1), (left, middle, halvings - 1)]
    lows, highs, parts, defined = zip(*panels, strict=True)
    return FieldModels(take(template, 0), np.array(lows), np.array(highs), np.stack(parts), np.stack(defined))


def _panel(models_of: ModelsOf, low: float, high: float) -> tuple[FloatArray | None, BoolArray]:
    """Return the numbers at the nodes of a panel, and the columns in which they reproduce the models between them."""
    places = np.concatenate([_NODES, CHECKED])
    models = models_of(0.5 * (low + high) + 0.5 * (high - low) * places)
    if models is None:
        return None, np.zeros(0, dtype=np.bool_)
    numbers = _to_rows(models)
    between = np.einsum("cn,nkx->ckx", _lagrange(np.array(CHECKED)), numbers[:NODES])
    size = np.abs(numbers).max(axis=(0, 1))
    for here, _ in _slices(models):
        size[here] = np.maximum(size[here], SMALLEST * size[here].max(initial=1e-300))
    error = np.abs(between - numbers[NODES:]) / size
    good = (error.max(axis=(0, 2)) < ACCURACY) & ~models.statically_unstable.any(axis=0)
    return numbers[:NODES], np.asarray(good)


def _lagrange(place: FloatArray) -> FloatArray:
    """Return the weights of the nodes at places (k,) by the barycentric formula: (k, nodes)."""
    gap = place[:, None] - _NODES
    hit = gap == 0.0
    share = _WEIGHTS / np.where(hit, 1.0, gap)
    share = np.where(hit.any(axis=1, keepdims=True), hit, share)
    return np.asarray(share / share.sum(axis=1, keepdims=True))


_OWN = ("mass", "damping", "stiffness", "shapes")
_OF_LOAD = tuple(field.name for field in fields(PolynomialLoad))
_OF_STRETCHING = tuple(field.name for field in fields(StretchingForce))


def _arrays(model: ReducedModel) -> list[FloatArray]:
    own: list[FloatArray] = [getattr(model, name) for name in _OWN]
    own += [getattr(model.load, name) for name in _OF_LOAD]
    return own if model.stretching is None else own + [getattr(model.stretching, name) for name in _OF_STRETCHING]


def _to_rows(model: ReducedModel) -> FloatArray:
    """Return all numbers of models as rows: (..., numbers)."""
    lead = model.statically_unstable.shape
    return np.concatenate([array.reshape(*lead, -1) for array in _arrays(model)], axis=-1)


def _slices(model: ReducedModel) -> list[tuple[slice, int]]:
    """Return the slice of each array in a row, and its length."""
    lead = model.statically_unstable.ndim
    lengths = [prod(array.shape[lead:]) for array in _arrays(model)]
    ends = np.cumsum(lengths).tolist()
    return [(slice(end - length, end), length) for end, length in zip(ends, lengths, strict=True)]


def _from_rows(template: ReducedModel, numbers: FloatArray) -> ReducedModel:
    """Convert rows (k, numbers) to models (k,) of the template's shapes."""
    arrays = [
        numbers[:, here].reshape(array.shape)
        for (here, _), array in zip(_slices(template), _arrays(template), strict=True)
    ]
    mass, damping, stiffness, shapes = arrays[: len(_OWN)]
    of_load, of_stretching = arrays[len(_OWN) :][: len(_OF_LOAD)], arrays[len(_OWN) + len(_OF_LOAD) :]
    return ReducedModel(
        mass,
        damping,
        stiffness,
        PolynomialLoad(*of_load),
        shapes,
        template.direction,
        template.statically_unstable,
        StretchingForce(*of_stretching) if of_stretching else None,
    )
