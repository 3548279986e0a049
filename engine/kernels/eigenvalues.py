"""Eigenvalues of stacks of matrices, by the kernel where it was built and they are small (eigenvalues.c)."""

import numpy as np

from engine import arrays
from engine.arrays import ComplexArray, FloatArray, merge_axes
from engine.kernels import compiled

LARGEST = 250  # rows, beyond which LAPACK is faster; the kernel takes no more than 1000


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Return the eigenvalues of finite matrices (..., n, n): (..., n); by LAPACK where large or hard."""
    if not compiled.AVAILABLE or matrices.shape[-1] > LARGEST:
        return arrays.eigenvalues(matrices)
    values = compiled.small_eigenvalues(merge_axes(matrices, -matrices.ndim, -3)).reshape(matrices.shape[:-1])
    failed = np.isnan(values).any(axis=-1)
    if failed.any():
        values[failed] = arrays.eigenvalues(matrices[failed])
    return values
