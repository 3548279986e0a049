"""How far input data carry a motion: which outcome the row of a computed motion has. Theory section 12."""

import math

import numpy as np

from engine.arrays import BoolArray, FloatArray
from engine.outcome import Outcome

LARGEST_ANGLE = math.radians(30.0)  # of attack, for coefficients whose fitted range is not known
_OUTCOMES = np.array([Outcome.CONVERGED, Outcome.BEYOND_DATA, Outcome.OUTSIDE_FIT], dtype=np.object_)


def motion_outcomes(
    angle: FloatArray, fitted_range: FloatArray, too_fast: BoolArray, amplitudes: FloatArray, sag: FloatArray
) -> list[Outcome]:
    """Return the outcome of motions that satisfy their equations.

    Parameters
    ----------
    angle : (motions,)
        Largest absolute angle of attack [rad].
    fitted_range : (motions,)
        Angle of attack up to which the line's coefficients are fitted [rad], infinite where it is not known.
    too_fast : (motions,)
        Whether a velocity leaves the range in which the load is expanded.
    amplitudes : (2, motions)
        Vertical and horizontal amplitude where the motion is observed [m].
    sag : (motions,)
        Static sag of the motion's line [m].

    Returns
    -------
    list of Outcome
        OUTSIDE_FIT beyond a known range or velocity; BEYOND_DATA beyond 30 degrees without a range, or beyond the sag;
        else CONVERGED.
    """
    unmeasured = np.isinf(fitted_range) & (angle > LARGEST_ANGLE)
    beyond = unmeasured | (amplitudes > sag).any(axis=0)
    outside = (angle > fitted_range) | too_fast
    verdicts: list[Outcome] = _OUTCOMES[np.where(outside, 2, beyond.astype(np.intp))].tolist()
    return verdicts
