"""Cubic fits of tabulated lift, drag and moment coefficients. Theory section 5, paper eqs. (A18), (A19)."""

from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import FloatArray
from engine.outcome import Fault, require
from engine.spec import Aerodynamics, Coefficients, MeasuredCoefficients

ORDER = 3
AT_REST = 1e-9  # rad from the static angle, below which a row lies on neither side of it


@dataclass(frozen=True, slots=True)
class CoefficientTable:
    """Measured coefficients of one iced sub-conductor: angle in rising order [rad], lift, drag, moment, all (rows,)."""

    angle: FloatArray
    lift: FloatArray
    drag: FloatArray
    moment: FloatArray

    def __post_init__(self) -> None:
        """Check shapes, finiteness and that the angles rise."""
        columns = {"angle": self.angle, "lift": self.lift, "drag": self.drag, "moment": self.moment}
        rising = self.angle.ndim == 1 and bool((np.diff(self.angle) > 0.0).all())
        require(
            *(
                Fault(f"table.{name}", column.shape, "must be finite and as long as the angles")
                for name, column in columns.items()
                if column.shape != self.angle.shape or not np.isfinite(column).all()
            ),
            None if rising else Fault("table.angle", self.angle.shape, "must be one column in rising order"),
        )


@dataclass(frozen=True, slots=True)
class CoefficientFit:
    """A cubic fit about the static angle: coefficients with their range, root mean square residuals, number of rows."""

    aerodynamics: Aerodynamics
    residual: Coefficients
    rows: int


def fit_coefficients(table: CoefficientTable, static_angle: float, half_range: float) -> CoefficientFit:
    """Fit C_y, C_z and C_theta by cubics in the angle relative to the static angle, constants included.

    Angles are compared modulo a full turn, so a table of the whole circle suits any static angle.

    Parameters
    ----------
    table : CoefficientTable
    static_angle : float
        [rad].
    half_range : float
        Rows within this angle of the static angle are used [rad].

    Returns
    -------
    CoefficientFit

    Raises
    ------
    InvalidSpec
        If fewer than five rows lie in the range, or all of them on one side of the static angle.
    """
    away = (table.angle - static_angle + np.pi) % (2.0 * np.pi) - np.pi
    here = np.abs(away) <= half_range * (1.0 + 1e-12)
    alpha = away[here]
    enough = alpha.size > ORDER + 1 and alpha.min() < -AT_REST and alpha.max() > AT_REST
    here_deg = f"{np.degrees(static_angle):.1f} deg"
    rule = f"must leave at least five rows of the table, on both sides of the static angle ({here_deg})"
    require(None if enough else Fault("half_range", half_range, rule))
    lift, drag = table.lift[here], table.drag[here]
    vertical = lift * np.cos(alpha) + drag * np.sin(alpha)
    horizontal = -lift * np.sin(alpha) + drag * np.cos(alpha)
    powers = alpha[:, None] ** np.arange(ORDER + 1)
    measured = np.stack([vertical, horizontal, table.moment[here]], axis=-1)
    coefficients = np.linalg.lstsq(powers, measured, rcond=None)[0]
    residual = np.sqrt(np.mean((powers @ coefficients - measured) ** 2, axis=0))
    rows = [_triple(column) for column in coefficients[1:].T]
    fitted_range = float(np.abs(alpha).max())
    aerodynamics = Aerodynamics(rows[0], rows[1], rows[2], _triple(coefficients[0]), fitted_range)
    return CoefficientFit(aerodynamics, _triple(residual), alpha.size)


def fit_measured(measured: MeasuredCoefficients, twist: float = 0.0) -> Aerodynamics:
    """Fit measured coefficients about the static angle plus a twist [rad].

    Raises
    ------
    InvalidSpec
        If the table breaks a rule of `CoefficientTable`, or has too few rows around that angle.
    """
    columns = (measured.angle, measured.lift, measured.drag, measured.moment)
    table = CoefficientTable(*(np.array(column) for column in columns))
    fitted = fit_coefficients(table, measured.static_angle + twist, measured.half_range)
    return replace(fitted.aerodynamics, measured=measured)


def den_hartog_coefficient(table: CoefficientTable) -> FloatArray:
    """Return dC_L/dalpha + C_D at each row of a table by central differences: (rows,); negative means unstable."""
    return np.asarray(np.gradient(table.lift, table.angle) + table.drag)


def _triple(values: FloatArray) -> Coefficients:
    first, second, third = values.tolist()
    return first, second, third
