"""The table of critical wind speeds. Theory section 6."""

import numpy as np

from engine.report.cells import lists_by_line
from engine.report.findings import ModelFindings
from engine.result import CriticalWindSpeedRow, Direction

DIRECTION_NAMES: tuple[Direction, ...] = ("vertical", "horizontal", "torsional")


def critical_wind_speed_rows(findings: ModelFindings) -> list[list[CriticalWindSpeedRow]]:
    """Return a row for every crossing of the imaginary axis, one list per line."""
    table: list[list[CriticalWindSpeedRow]] = lists_by_line(findings.line)
    crossings = findings.crossings
    for i, member in enumerate(crossings.member):
        row = CriticalWindSpeedRow(
            model=findings.name,
            loops=int(findings.loops[member, crossings.coordinate[i]]),
            wind_speed_m_per_s=float(crossings.wind_speed[i]),
            crossing="onset" if crossings.onset[i] else "restabilization",
            type="oscillation" if crossings.oscillation[i] else "divergence",
            direction=DIRECTION_NAMES[findings.model.direction[crossings.coordinate[i]]],
            frequency_hz=float(crossings.angular_frequency[i] / (2.0 * np.pi)),
            unstable_pairs_after=int(crossings.unstable_after[i]),
        )
        table[findings.line[member]].append(row)
    return table
