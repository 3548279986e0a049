"""Growth of small motion about the static state at the requested wind speeds. Theory section 6."""

from engine.arrays import ComplexArray, FloatArray, merge_axes
from engine.kernels.eigenvalues import eigenvalues
from engine.models.critical_wind_speeds import at_wind, state_matrices
from engine.models.reduced_model import ReducedModel, of_each_member


def eigenvalues_at_rest(model: ReducedModel, wind_speeds: FloatArray) -> ComplexArray:
    """Return the eigenvalues of the equations linearized about the static state [1/s].

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,); the values of statically unstable members have no meaning.
    wind_speeds : (winds,) or (members, winds)
        Of all members or of each [m/s].

    Returns
    -------
    (members, winds, 2 m)
    """
    matrices = at_wind(state_matrices(model), of_each_member(model, wind_speeds))
    return eigenvalues(merge_axes(matrices, -4, -3)).reshape(matrices.shape[:-1])
