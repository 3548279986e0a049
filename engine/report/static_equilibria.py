"""The table of static equilibria: angles at which the sections rest in the wind. Theory section 14."""

import numpy as np

from engine.arrays import FloatArray
from engine.models.discretization import Discretization
from engine.outcome import Outcome
from engine.report.cells import finite_or_none
from engine.result import StaticEquilibriumRow


def static_equilibrium_rows(
    discretization: Discretization, wind_speeds: FloatArray
) -> list[list[StaticEquilibriumRow]]:
    """Return a row for each equilibrium at each wind speed (winds,) [m/s], one list per line."""
    found = discretization.wind_twist
    table: list[list[StaticEquilibriumRow]] = [[] for _ in discretization.lines]
    if found is None:
        return table
    for line, rows in enumerate(table):
        if not discretization.lines[line].has_table or any(discretization.lines[line].curve_faults()):
            continue
        for wind, speed in enumerate(wind_speeds.tolist()):
            here = (found.further_line == line) & (found.further_wind == wind)
            rows.append(_row(speed, 0, found.angle[line, wind], found.outcome[line, wind]))
            rows += [_row(speed, i, angle, Outcome.CONVERGED) for i, angle in enumerate(found.further_angle[here], 1)]
    return table


def _row(wind_speed: float, number: int, angle: FloatArray, outcome: Outcome) -> StaticEquilibriumRow:
    middle, largest = float(angle[angle.size // 2]), float(angle[np.abs(angle).argmax()])
    return StaticEquilibriumRow(wind_speed, number, finite_or_none(middle), finite_or_none(largest), outcome)
