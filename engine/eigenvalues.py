"""Eigenvalues of stacks of small real matrices."""

import numpy as np

from engine import compiled
from engine.arrays import ComplexArray, FloatArray


def eigenvalues(matrices: FloatArray) -> ComplexArray:
    """Find the eigenvalues (..., n) of finite real matrices (..., n, n), in no order."""
    if compiled.AVAILABLE:
        return compiled.small_eigenvalues(matrices)
    return np.asarray(np.linalg.eigvals(matrices), dtype=np.complex128)
