"""Array types of the engine, and the few array operations that several packages share."""

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.intp]
BoolArray = NDArray[np.bool_]
ObjectArray = NDArray[np.object_]
AnyArray = NDArray[Any]
Value = TypeVar("Value")


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Return the eigenvalues (..., n) of finite real matrices (..., n, n), in no particular order."""
    return np.asarray(np.linalg.eigvals(matrices), dtype=np.complex128)


def lengths(vectors: FloatArray) -> FloatArray:
    """Return the Euclidean norms of vectors (..., n): (...); numpy's norm takes twice as long for small stacks."""
    return np.asarray(np.sqrt(np.einsum("...i,...i->...", vectors, vectors)))


def times_matrix(vectors: FloatArray, matrix: FloatArray) -> FloatArray:
    """Return the products of row vectors (..., n) with a matrix (n, k): (..., k).

    Taken as one product of two matrices: numpy multiplies those of a stack one by one.
    """
    return np.asarray((vectors.reshape(-1, matrix.shape[0]) @ matrix).reshape(*vectors.shape[:-1], matrix.shape[1]))


def merge_axes(array: AnyArray, first: int, last: int = -1) -> AnyArray:
    """Merge the axes from first to last (both negative) into one, of empty stacks too."""
    shape = array.shape
    stop = array.ndim + last + 1
    start = array.ndim + first
    return array.reshape(*shape[:start], math.prod(shape[start:stop]), *shape[stop:])


def take_rows(stack: Any, index: AnyArray) -> Any:
    """Select or repeat entries of a dataclass whose fields are all arrays with the same first axis."""
    return replace(stack, **{field.name: getattr(stack, field.name)[index] for field in fields(stack)})


def filled(count: int, value: object) -> ObjectArray:
    """Return an array (count,) that holds one object; `numpy.full` would store a `StrEnum`'s member as plain text."""
    result = np.empty(count, dtype=np.object_)
    result.fill(value)
    return result


def placed(values: Sequence[Value], wanted: Sequence[bool]) -> list[Value | None]:
    """Return values in their order where they are wanted, None elsewhere.

    Raises
    ------
    ValueError
        If there are more or fewer values than places for them.
    """
    places = [place for place, here in enumerate(wanted) if here]
    found = dict(zip(places, values, strict=True))
    return [found.get(place) for place in range(len(wanted))]
