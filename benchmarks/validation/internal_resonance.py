"""How close the source's lines are to internal resonance, and how their cycles' energy divides between directions."""

from collections.abc import Iterator

from benchmarks.validation.common import SUBCONDUCTORS, WINDS, source_results, table
from engine.result import Result

DIRECTIONS = ("horizontal:vertical", "torsional:vertical", "torsional:horizontal")


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Internal resonance\n"
    yield (
        "The source names a 1:1:0 resonance (vertical : horizontal : torsional) in one loop and a possible 1:1:1 "
        "resonance in two loops of the bundles. The table holds the frequency ratios of the hybrid model without wind "
        "and, in brackets, the nearest ratio of integers up to 3 and the detuning in %. The last three columns are the "
        f"shares of the directions in the mean kinetic energy of the stable cycle at {WINDS[0]:g} m/s.\n"
    )
    head = ["n", "loops", *DIRECTIONS, "vertical share", "horizontal share", "torsional share"]
    yield table(head, [_row(n, loops) for n in SUBCONDUCTORS for loops in (1, 2)])


def _row(subconductors: int, loops: int) -> list[object]:
    result = source_results()[subconductors]
    near = {
        row.directions: f"{row.frequency_ratio:.4f} ({row.nearest_ratio}, {100.0 * row.detuning:+.2f})"
        for row in result.internal_resonances
        if (row.model, row.loops) == ("hybrid", loops)
    }
    return [subconductors, loops, *(near[name] for name in DIRECTIONS), *_shares(result, loops)]


def _shares(result: Result, loops: int) -> list[str]:
    row = next(
        r
        for r in result.limit_cycles
        if (r.model, r.loops, r.wind_speed_m_per_s, r.kind) == ("hybrid", loops, WINDS[0], "periodic")
        and r.stability == "stable"
    )
    return [f"{share or 0.0:.4f}" for share in (row.vertical_share, row.horizontal_share, row.torsional_share)]
