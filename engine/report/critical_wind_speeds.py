"""The table of critical wind speeds. Theory section 6."""

import numpy as np

from engine.arrays import FloatArray
from engine.report.cells import lists_by_line
from engine.report.findings import ModelFindings
from engine.result import CriticalWindSpeedRow, Direction

DIRECTION_NAMES: tuple[Direction, ...] = ("vertical", "horizontal", "torsional")


def critical_wind_speed_rows(
    findings: ModelFindings, loops: tuple[int, ...], longitudinal: FloatArray
) -> list[list[CriticalWindSpeedRow]]:
    """Return a row for every crossing of the imaginary axis, one list per line.

    Parameters
    ----------
    findings : ModelFindings
    loops : tuple of int
        Numbers of loops of the vertical shapes.
    longitudinal : (lines, loops)
        Share of longitudinal motion in them; a shape that is nearer to longitudinal than to vertical is called so.
    """
    table: list[list[CriticalWindSpeedRow]] = lists_by_line(findings.line)
    crossings = findings.crossings
    for i, member in enumerate(crossings.member):
        count = int(findings.loops[member, crossings.coordinate[i]])
        direction = DIRECTION_NAMES[findings.model.direction[crossings.coordinate[i]]]
        if direction == "vertical" and longitudinal[findings.line[member], loops.index(count)] > 0.5:
            direction = "longitudinal"
        row = CriticalWindSpeedRow(
            model=findings.name,
            loops=count,
            wind_speed_m_per_s=float(crossings.wind_speed[i]),
            crossing="onset" if crossings.onset[i] else "restabilization",
            type="oscillation" if crossings.oscillation[i] else "divergence",
            direction=direction,
            frequency_hz=float(crossings.angular_frequency[i] / (2.0 * np.pi)),
            unstable_pairs_after=int(crossings.unstable_after[i]),
        )
        table[findings.line[member]].append(row)
    return table
