"""Eigenvalues of stacks of small matrices, by the kernel where it was built (engine/kernels/eigenvalues.c)."""

import numpy as np

from engine import arrays
from engine.arrays import ComplexArray, FloatArray, merge_axes
from engine.kernels import compiled


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Return the eigenvalues of finite matrices (..., n, n): (..., n); LAPACK finds those where the kernel fails."""
    if not compiled.AVAILABLE:
        return arrays.eigenvalues(matrices)
    values = compiled.small_eigenvalues(merge_axes(matrices, -matrices.ndim, -3)).reshape(matrices.shape[:-1])
    failed = np.isnan(values).any(axis=-1)
    if failed.any():
        values[failed] = arrays.eigenvalues(matrices[failed])
    return values
