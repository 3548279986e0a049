"""Limit cycles beside the reference of theory section 10."""

from collections.abc import Iterator

from benchmarks.validation.common import REFERENCE, WINDS, percent, source_results, table


def section() -> Iterator[str]:
    """Yield the section's text."""
    results, rows = source_results(), []
    for entry in REFERENCE["orbits"]:
        for wind in WINDS:
            found = next(
                r
                for r in results[entry["subconductors"]].limit_cycles
                if (r.model, r.loops, r.wind_speed_m_per_s) == ("hybrid", entry["loops"], wind)
                and r.kind == "periodic"
                and r.stability == "stable"
            )
            values = [found.vertical_m or 0.0, found.horizontal_m or 0.0, found.torsional_rad or 0.0]
            expected = entry[str(wind)]
            cells = [f"{v:.4f} ({e:.4f}, {percent(v, e)} %)" for v, e in zip(values, expected, strict=True)]
            rows.append([entry["subconductors"], entry["loops"], f"{wind:g}", *cells])
    yield "## Limit cycles of the hybrid model\n"
    yield (
        "Each cell holds the computed amplitude and, in brackets, the reference (direct integration until the motion "
        "settles) and the difference.\n"
    )
    yield table(["n", "loops", "wind m/s", "vertical m", "horizontal m", "torsional rad"], rows)
