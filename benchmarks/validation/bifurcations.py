"""Where branches of cycles change on the source's lines with light torsion, and which stable cycles coexist there."""

from collections.abc import Iterator
from dataclasses import dataclass

from benchmarks.lines import source_line
from benchmarks.validation.common import result, table
from engine.result import LimitCycleRow
from engine.spec import Analysis, Check, Model

LIGHT, VERY_LIGHT = 0.0308, 0.01
ROUNDING = 1e-10  # m/s: what is smaller differs from machine to machine


@dataclass(frozen=True, slots=True)
class Case:
    """A source line by its number of sub-conductors and torsional damping ratio, loops and wind speeds [m/s]."""

    subconductors: int
    torsional_ratio: float
    loops: int
    winds: tuple[float, ...]

    def analysis(self, check: Check = Check.NONE) -> Analysis:
        """Ask for the motions of the hybrid model."""
        return Analysis(loops=(self.loops,), models=(Model.HYBRID,), wind_speeds=self.winds, check=check)


BRANCHES = (Case(1, VERY_LIGHT, 1, (4.0, 8.0, 12.0)), *(Case(n, LIGHT, 2, (4.0, 8.0, 12.0)) for n in (1, 2, 3, 4)))
COEXISTING = (
    Case(1, LIGHT, 2, (8.0, 9.0, 10.0)),
    *(Case(n, LIGHT, 2, (12.0,)) for n in (2, 3, 4)),
    Case(1, 0.308, 3, (20.0,)),
)


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Bifurcations and coexisting cycles\n"
    yield (
        "Hybrid model with a tenth of the source's torsional damping ratio or less. The branch of every Hopf point is "
        "followed to 12.6 m/s. AUTO finds torus points on the two-loop branches with the ratio 0.0308 between 7 and 12 "
        "m/s, and folds on the one-loop branch of the single conductor with the ratio 0.01.\n"
    )
    head = ["n", "torsional ratio", "loops", "branch", "type", "wind m/s", "f1 Hz", "f2 Hz", "uncertainty m/s"]
    yield table(head, [row for case in BRANCHES for row in _turning(case)])
    yield (
        "\nStable cycles that coexist at one wind speed. The difference is the change of the largest amplitude over 50 "
        "periods of direct integration (DOP853, relative tolerance 1e-8) that starts on the cycle. Direct integration "
        "from large starts (`check: direct`) found no further cycle unless the last column says so.\n"
    )
    head = ["n", "torsional ratio", "loops", "wind m/s", "branch", "vertical m", "horizontal m", "torsional rad"]
    yield table([*head, "difference %", "found by"], [row for case in COEXISTING for row in _stable(case)])


def _turning(case: Case) -> Iterator[list[object]]:
    line = source_line(case.subconductors, torsional_ratio=case.torsional_ratio)
    for row in result(line, case.analysis()).bifurcations:
        second = "" if row.second_frequency_hz is None else f"{row.second_frequency_hz:.5f}"
        place = [case.subconductors, case.torsional_ratio, case.loops, row.branch, row.type]
        yield [
            *place,
            f"{row.wind_speed_m_per_s:.5f}",
            f"{row.frequency_hz:.5f}",
            second,
            f"{row.uncertainty_m_per_s:.0e}" if row.uncertainty_m_per_s >= ROUNDING else f"below {ROUNDING:.0e}",
        ]


def _stable(case: Case) -> Iterator[list[object]]:
    line = source_line(case.subconductors, torsional_ratio=case.torsional_ratio)
    for row in result(line, case.analysis(Check.DIRECT)).limit_cycles:
        if row.kind == "periodic" and row.stability == "stable":
            place = [case.subconductors, case.torsional_ratio, case.loops, f"{row.wind_speed_m_per_s:g}", row.branch]
            yield [*place, *_amplitudes(row), f"{100.0 * (row.direct_difference or 0.0):+.3f}", row.found_by]


def _amplitudes(row: LimitCycleRow) -> list[str]:
    return [f"{value or 0.0:.4f}" for value in (row.vertical_m, row.horizontal_m, row.torsional_rad)]
