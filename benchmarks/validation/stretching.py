"""The frequency of large free vibrations beside exact chains of bars. Theory section 12.1."""

from collections.abc import Iterator

from benchmarks.free_vibration import EXACT_SHIFTS, SPANS, finite_element_shift, hybrid_shift
from benchmarks.validation.common import table


def section() -> Iterator[str]:
    """Yield the section's text."""
    rows = []
    for name, amplitude, exact in EXACT_SHIFTS:
        found = [100.0 * shift(SPANS[name], amplitude) for shift in (hybrid_shift, finite_element_shift)]
        rows.append([name, amplitude, f"{exact:.3f}", *(f"{value:.3f}" for value in found)])
    yield "## Stretching\n"
    yield (
        "Shift of the frequency of two horizontal loops, in percent, when they swing freely with an amplitude A: an\n"
        "exact chain of bars (theory section 12.1), the hybrid model with its relief coordinate, and the finite\n"
        "element model with the modes of 1, 2, 3 and 5 loops. Long spans between dead ends give way in\n"
        "more shapes than one: there the hybrid model is some 4 % off in the shift.\n"
    )
    yield table(["span", "A m", "exact %", "hybrid %", "finite element %"], rows)
