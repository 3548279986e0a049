"""Fits of measured coefficients: what goes out, ready for a line's ice."""

from app import convert
from app.answers.rows import DenHartog
from app.schemas.environment import COEFFICIENTS, Aerodynamics, AerodynamicsAtRest
from app.schemas.fields import Answer, example_of, told


class FitResidual(Answer):
    """Root mean square of what the cubics leave of the measured coefficients."""

    vertical: float = told("Of C_y [1]", 0.012)
    horizontal: float = told("Of C_z [1]", 0.009)
    torsional: float = told("Of C_theta [1]", 0.004)


class DenHartogRow(Answer):
    """Den Hartog's criterion at one row of the table."""

    angle_deg: float = told("Angle of the row [deg]", 40.0)
    coefficient: float = told("dC_L/dalpha + C_D there, by central differences [1/rad]", -0.15)
    unstable: bool = told("Whether the coefficient is negative", True)


class FitAnswer(Answer):
    """Cubics about the static angle; the first two members can be put into a line's `ice` as they are."""

    aerodynamics: Aerodynamics = told(
        "Coefficients, with the range of angles for which they hold", {**COEFFICIENTS, "fitted_range_deg": 20.0}
    )
    aerodynamics_at_rest: AerodynamicsAtRest = told(
        "Constant terms, which the relative-wind model needs", {"vertical": 0.31, "horizontal": 1.18, "torsional": 0.1}
    )
    residual: FitResidual = told("What the fit leaves", example_of(FitResidual))
    rows_used: int = told("Rows of the table within the range [1]", 21)
    den_hartog: DenHartog = told(
        "Den Hartog's criterion of the fit, at the static angle", convert.example_row(convert.DenHartog)
    )
    den_hartog_over_angle: list[DenHartogRow] = told("The same over the whole table", [example_of(DenHartogRow)])
