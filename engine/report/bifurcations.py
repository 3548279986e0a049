"""The table of bifurcations. Theory sections 7.2 and 7.3."""

import numpy as np

from engine.report.cells import finite_or_none, lists_by_line
from engine.report.findings import ModelFindings
from engine.result import BifurcationRow


def bifurcation_rows(findings: ModelFindings) -> list[list[BifurcationRow]]:
    """Return a row for every bifurcation, one list per line."""
    table: list[list[BifurcationRow]] = lists_by_line(findings.line)
    bifurcations = findings.bifurcations
    for i, member in enumerate(bifurcations.member.tolist()):
        row = BifurcationRow(
            model=findings.name,
            loops=int(findings.loops[member, bifurcations.coordinate[i]]),
            branch=int(bifurcations.branch[i]),
            type=bifurcations.kind[i].value,
            wind_speed_m_per_s=float(bifurcations.parameter[i]),
            frequency_hz=float(bifurcations.angular_frequency[i] / (2.0 * np.pi)),
            second_frequency_hz=finite_or_none(float(bifurcations.second_frequency[i] / (2.0 * np.pi))),
            uncertainty_m_per_s=float(bifurcations.uncertainty[i]),
        )
        table[findings.line[member]].append(row)
    return table
