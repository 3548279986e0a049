"""A sparse polynomial chaos expansion of what the samples gave, with its error at samples that it has not seen."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray
from engine.uncertainty.expansion_terms import design, terms_up_to
from engine.uncertainty.inputs import Uncertain

FOLDS = 8
CANDIDATES = 1000  # terms from which an expansion is chosen
TERMS = 60  # of an expansion
HIGHEST_DEGREE = 12
PATIENCE = 2  # degrees in a row that may fail to lower the error
EXACT = 1e-12  # residual relative to the spread of the values, below which there is nothing left to fit
DEPENDENT = 1e-8  # length of what is new in a term, relative to the term


@dataclass(frozen=True, slots=True)
class Surrogate:
    """An expansion in orthonormal terms.

    terms: (terms, inputs), number of the function of each input, the constant first; matrix: the terms at the samples
    (samples, terms); coefficients (terms,); explained: share of the variance that an expansion made without a sample
    predicts there, 1 for a perfect one, below 0 for one that is worse than the mean.
    """

    terms: IntArray
    matrix: FloatArray
    coefficients: FloatArray
    explained: float


def surrogate(inputs: Sequence[Uncertain], unit: FloatArray, values: FloatArray) -> Surrogate | None:
    """Fit an expansion to the values at samples, None if they are fewer than two folds or do not differ.

    Orthogonal matching pursuit takes up the terms one after another. Cross-validation, which repeats that choice
    without each eighth of the samples, decides how many, and up to which degree (a survey of such expansions: Luethen,
    Marelli and Sudret 2021, Sparse polynomial chaos expansions: literature survey and benchmark).

    Parameters
    ----------
    inputs : sequence of Uncertain
    unit : (samples, inputs)
    values : (samples,)
    """
    spread = float(np.var(values)) if values.size else 0.0
    if values.size < 2 * FOLDS or spread <= EXACT * float(np.mean(values**2)):
        return None
    best: tuple[float, IntArray, FloatArray] | None = None
    failed = 0
    for degree in range(1, HIGHEST_DEGREE + 1):
        terms = terms_up_to(inputs, degree)
        if degree > 1 and terms.shape[0] > CANDIDATES:
            break
        matrix = design(inputs, unit, terms)
        errors = _left_out_errors(matrix, values)
        size = int(np.argmin(errors))
        if best is not None and errors[size] >= best[0]:
            failed += 1
        else:
            chosen = _pursuit(matrix, values, np.ones(values.size, dtype=np.bool_), size)[0]
            best, failed = (float(errors[size]), terms[chosen], matrix[:, chosen]), 0
        if failed == PATIENCE or (best is not None and best[0] <= EXACT * spread):
            break
    assert best is not None, "the first degree always has a best size"
    error, terms, matrix = best
    coefficients = np.asarray(np.linalg.lstsq(matrix, values, rcond=None)[0], dtype=np.float64)
    return Surrogate(terms, matrix, coefficients, 1.0 - error / spread)


def _left_out_errors(matrix: FloatArray, values: FloatArray) -> FloatArray:
    """Return the mean square of errors at samples that were left out, by the number of terms besides the constant.

    The folds are successive samples: each stretch of a Sobol sequence fills the ranges evenly.
    """
    fold = np.arange(values.size) * FOLDS // values.size
    most = min(TERMS, values.size // 2, matrix.shape[1] - 1)
    total = np.zeros(most + 1)
    for number in range(FOLDS):
        _, errors = _pursuit(matrix, values, fold != number, most)
        total += errors
    return total / values.size


def _pursuit(matrix: FloatArray, values: FloatArray, kept: BoolArray, most: int) -> tuple[list[int], FloatArray]:
    """Take up terms by their correlation with what is left, and fit all of them anew each time.

    Parameters
    ----------
    matrix : (samples, terms)
        The constant first, which is always in.
    values : (samples,)
    kept : (samples,)
        The samples to fit.
    most : int
        Number of terms to take up besides the constant.

    Returns
    -------
    chosen : list of int
        Terms in their order.
    errors : (most + 1,)
        Sum of squared errors at the samples that are not kept, after each term.
    """
    known = np.ascontiguousarray(matrix[kept].T)
    sizes = np.sqrt(np.einsum("ij,ij->i", known, known))
    basis = np.zeros((values.size, most + 1))
    basis[:, 0] = 1.0 / np.sqrt(np.count_nonzero(kept))
    rest = values - values[kept].mean()
    enough = EXACT * float(np.linalg.norm(rest[kept]))
    free = sizes > 0.0
    free[0] = False
    chosen, errors = [0], [float(rest[~kept] @ rest[~kept])]
    while len(chosen) <= most and free.any() and np.linalg.norm(rest[kept]) > enough:
        fit = np.where(free, np.abs(known @ rest[kept]) / np.where(sizes > 0.0, sizes, 1.0), -1.0)
        best = int(np.argmax(fit))
        free[best] = False
        new, old = matrix[:, best].copy(), basis[:, : len(chosen)]
        for _ in range(2):  # once more for what rounding left
            new -= old @ (old[kept].T @ new[kept])
        length = float(np.linalg.norm(new[kept]))
        if length <= DEPENDENT * sizes[best]:
            continue
        new /= length
        basis[:, len(chosen)] = new
        rest = rest - new * float(new[kept] @ rest[kept])
        chosen.append(best)
        errors.append(float(rest[~kept] @ rest[~kept]))
    return chosen, np.array(errors + [errors[-1]] * (most + 1 - len(errors)))
