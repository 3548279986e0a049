"""Natural frequencies beside the source's Table 2."""

import json
from collections.abc import Iterator

from benchmarks.validation.common import ROOT, percent, source_results, table

TABLE_2 = json.loads((ROOT / "app" / "data" / "table2.json").read_text())


def section() -> Iterator[str]:
    """Yield the section's text."""
    results = source_results()
    rows, largest = [], {"hybrid": 0.0, "finite_element": 0.0}
    for entry in TABLE_2["rows"]:
        for loops, source in entry["loops"].items():
            found = next(
                r
                for r in results[entry["subconductors"]].frequencies
                if r.model == entry["model"] and r.loops == int(loops)
            )
            values = [found.vertical_hz or 0.0, found.horizontal_hz or 0.0, found.torsional_hz or 0.0]
            change = [percent(v, s) for v, s in zip(values, source, strict=True)]
            largest[entry["model"]] = max(largest[entry["model"]], *(abs(float(c)) for c in change))
            cells = [f"{v:.4f} ({s:.3f}, {c} %)" for v, s, c in zip(values, source, change, strict=True)]
            rows.append([entry["subconductors"], entry["model"].replace("_", " "), loops, *cells])
    yield "## Natural frequencies: the source's Table 2\n"
    yield "Each cell holds the computed frequency in Hz and, in brackets, the source's value and the difference.\n"
    yield table(["n", "model", "loops", "vertical", "horizontal", "torsional"], rows)
    yield (
        f"\nAll {3 * len(rows)} entries: largest difference {largest['hybrid']:.2f} % for the hybrid model, "
        f"{largest['finite_element']:.2f} % for the finite element model."
    )
