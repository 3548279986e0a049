"""Answers of fits to measured coefficients, ready for a line's ice."""

from app import convert
from app.answers.rows import DenHartog
from app.schemas.environment import COEFFICIENTS, Aerodynamics, AerodynamicsAtRest
from app.schemas.fields import Answer, described, example_of


class FitResidual(Answer):
    """Root mean square residual of the cubics against the measured coefficients."""

    vertical: float = described("Residual of C_y [1]", 0.012)
    horizontal: float = described("Residual of C_z [1]", 0.009)
    torsional: float = described("Residual of C_theta [1]", 0.004)


class DenHartogRow(Answer):
    """Den Hartog's criterion at one row of the table."""

    angle_deg: float = described("Angle of the row [deg]", 40.0)
    coefficient: float = described("dC_L/dalpha + C_D at this angle, by central differences [1/rad]", -0.15)
    unstable: bool = described("Whether the coefficient is negative", True)


class FitAnswer(Answer):
    """Cubics about the static angle; a line's `ice` accepts the first two members unchanged."""

    aerodynamics: Aerodynamics = described(
        "Coefficients, with the range of angles for which they hold", {**COEFFICIENTS, "fitted_range_deg": 20.0}
    )
    aerodynamics_at_rest: AerodynamicsAtRest = described(
        "Constant terms, which the relative-wind model needs", {"vertical": 0.31, "horizontal": 1.18, "torsional": 0.1}
    )
    residual: FitResidual = described("Residual of the fit", example_of(FitResidual))
    rows_used: int = described("Rows of the table within the range [1]", 21)
    den_hartog: DenHartog = described(
        "Den Hartog's criterion of the fit, at the static angle", convert.example_row(convert.DenHartog)
    )
    doubts: list[str] = described("Slips that the table shows: units of angles, lift and drag swapped", [])
    ice_direction_deg: float | None = described(
        "Where the moments have the ice point at angle 0, clockwise from straight up; if that is the opposite side, "
        "the moment has the other sign; null if no centre of pressure explains them [deg]",
        287.0,
    )
    den_hartog_over_angle: list[DenHartogRow] = described(
        "Den Hartog's criterion over the whole table", [example_of(DenHartogRow)]
    )
