"""Critical wind speeds beside the reference of theory section 10."""

from collections.abc import Iterator

from benchmarks.validation.common import REFERENCE, percent, source_results, table


def section() -> Iterator[str]:
    """Yield the section's text."""
    results, rows = source_results(), []
    for entry in REFERENCE["critical_wind_speeds"]:
        for crossing in ("onset", "restabilization"):
            if crossing in entry:
                found = next(
                    r.wind_speed_m_per_s
                    for r in results[entry["subconductors"]].critical_wind_speeds
                    if r.model == "hybrid" and r.loops == entry["loops"] and r.crossing == crossing
                )
                expected = entry[crossing]
                numbers = (f"{found:.4f}", f"{expected:.3f}", percent(found, expected))
                rows.append([entry["subconductors"], entry["loops"], crossing, *numbers])
    yield "## Critical wind speeds of the hybrid model\n"
    yield table(["n", "loops", "crossing", "computed m/s", "expected m/s", "difference %"], rows)
