"""Direct integration that starts on the orbits of the harmonic balance."""

from collections.abc import Iterator

import numpy as np

from benchmarks.engine_speed import found_cycles
from benchmarks.lines import source_line
from benchmarks.models import discretized, first_antinode, hybrid_models
from benchmarks.validation.common import WINDS, table
from engine.checks.time_integration import integrate
from engine.cycles.harmonic_balance import half_peak_to_peak, select, states
from engine.models.reduced_model import take

CYCLES = 300


def section() -> Iterator[str]:
    """Yield the section's text."""
    rows = [row for n in (1, 2, 3) for row in _integrated(n)]
    yield "## Harmonic balance against direct integration\n"
    yield (
        f"Direct integration (DOP853, relative tolerance 1e-8) starts on each orbit and runs for {CYCLES} cycles. The "
        "last 50 cycles give the amplitude in brackets. A stable orbit must stay where it is.\n"
    )
    yield table(["n", "loops", "wind m/s", "vertical m", "horizontal m", "torsional rad", "largest change %"], rows)


def _integrated(subconductors: int) -> Iterator[list[object]]:
    discretization = discretized((source_line(subconductors),))
    model, published = hybrid_models(discretization, (1, 2))
    winds = np.array(WINDS)
    cycles = found_cycles(model, published, winds)
    for i in np.flatnonzero(cycles.floquet.stability == "stable"):
        orbit = select(cycles.orbits, np.array([i]))
        member = int(cycles.member[i])
        state = states(orbit, np.zeros(1))[0, 0]
        state[3:] *= orbit.wind_speed[0]
        settled = integrate(take(model, member), float(orbit.wind_speed[0]), state, change=0.0, longest=CYCLES)
        seen = first_antinode(model.shapes[[member]], member + 1)[0]
        after = 0.5 * np.ptp(settled.history @ seen, axis=0)
        before = half_peak_to_peak(seen.T @ orbit.coefficients[0])
        change = 100.0 * np.abs(after / before - 1.0).max()
        cells = [f"{a:.4f} ({b:.4f})" for a, b in zip(before.tolist(), after.tolist(), strict=True)]
        yield [subconductors, member + 1, f"{orbit.wind_speed[0]:g}", *cells, f"{change:.3f}"]
