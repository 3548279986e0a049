"""Write docs/validation.md: the source's figures beside the engine's. `make validation` runs it."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.lines import source_line
from engine.analysis import analyse
from engine.cycles import explicit_starts, find_cycles
from engine.fem import matrices
from engine.harmonic import Orbits, half_peak_to_peak, states
from engine.hybrid import Discretization, hybrid_model, observation, take, with_published_load
from engine.integrate import integrate
from engine.modes import directional_shapes
from engine.profile import static_profile
from engine.result import Result
from engine.sections import sections
from engine.spec import Analysis, Line

ROOT = Path(__file__).parents[1]
TABLE_2 = json.loads((ROOT / "app" / "data" / "table2.json").read_text())
REFERENCE = json.loads((ROOT / "benchmarks" / "reference.json").read_text())
WINDS = (4.0, 6.0)
CYCLES = 300


def main() -> None:
    """Compute everything and write the document."""
    results = {n: _result(source_line(n)) for n in (1, 2, 3, 4)}
    parts = [HEADER, *_frequencies(results), *_critical(results), *_orbits(results), *_brute_force()]
    (ROOT / "docs" / "validation.md").write_text("\n".join(parts) + "\n")


HEADER = """# Validation

Every figure on this page is written by `make validation` (benchmarks/validation.py). The lines are those of the
source's Table 1 with one to four sub-conductors, constant damping coefficient, exact closure, ten elements.
Theory and section numbers are explained in [conventions](conventions.md)."""


def _result(line: Line) -> Result:
    steps = analyse(line, Analysis(loops=(1, 2, 3), wind_speeds=WINDS))
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            result: Result = stop.value
            return result


def _table(head: list[str], rows: list[list[str]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def _percent(value: float, reference: float) -> str:
    return f"{100.0 * (value / reference - 1.0):+.2f}"


def _frequencies(results: dict[int, Result]) -> Iterator[str]:
    rows, largest = [], {"hybrid": 0.0, "finite_element": 0.0}
    for entry in TABLE_2["rows"]:
        for loops, source in entry["loops"].items():
            found = next(
                r
                for r in results[entry["subconductors"]].frequencies
                if r.model == entry["model"] and r.loops == int(loops)
            )
            values = [found.vertical_hz or 0.0, found.horizontal_hz or 0.0, found.torsional_hz or 0.0]
            change = [_percent(v, s) for v, s in zip(values, source, strict=True)]
            largest[entry["model"]] = max(largest[entry["model"]], *(abs(float(c)) for c in change))
            cells = [f"{v:.4f} ({s:.3f}, {c} %)" for v, s, c in zip(values, source, change, strict=True)]
            rows.append([str(entry["subconductors"]), entry["model"].replace("_", " "), loops, *cells])
    yield "\n## Natural frequencies: the source's Table 2\n"
    yield "Computed value in Hz, in brackets the source's value and the difference.\n"
    yield _table(["n", "model", "loops", "vertical", "horizontal", "torsional"], rows)
    yield (
        f"\nAll {3 * len(rows)} entries: largest difference {largest['hybrid']:.2f} % for the hybrid model, "
        f"{largest['finite_element']:.2f} % for the finite element model."
    )


def _critical(results: dict[int, Result]) -> Iterator[str]:
    rows = []
    for entry in REFERENCE["critical_wind_speeds"]:
        for crossing in ("onset", "restabilization"):
            if crossing in entry:
                found = next(
                    r.wind_speed_m_per_s
                    for r in results[entry["subconductors"]].critical_wind_speeds
                    if r.model == "hybrid" and r.loops == entry["loops"] and r.crossing == crossing
                )
                expected = entry[crossing]
                rows.append(
                    [
                        str(entry["subconductors"]),
                        str(entry["loops"]),
                        crossing,
                        f"{found:.4f}",
                        f"{expected:.3f}",
                        _percent(found, expected),
                    ]
                )
    yield "\n## Critical wind speeds of the hybrid model\n"
    yield _table(["n", "loops", "crossing", "computed m/s", "expected m/s", "difference %"], rows)


def _orbits(results: dict[int, Result]) -> Iterator[str]:
    rows = []
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
            cells = [f"{v:.4f} ({e:.4f}, {_percent(v, e)} %)" for v, e in zip(values, expected, strict=True)]
            rows.append([str(entry["subconductors"]), str(entry["loops"]), f"{wind:g}", *cells])
    yield "\n## Limit cycles of the hybrid model\n"
    yield "Computed amplitude, in brackets the reference by direct integration until settled and the difference.\n"
    yield _table(["n", "loops", "wind m/s", "vertical m", "horizontal m", "torsional rad"], rows)


def _brute_force() -> Iterator[str]:
    rows = [row for n in (1, 2, 3) for row in _integrated(source_line(n), n)]
    yield "\n## Harmonic balance against direct integration\n"
    yield (
        f"Each orbit is the start of {CYCLES} cycles of direct integration (DOP853, relative tolerance 1e-8); the last "
        "50 cycles give the amplitude. Stable orbits must stay where they are.\n"
    )
    yield _table(["n", "loops", "wind m/s", "vertical m", "horizontal m", "torsional rad", "largest change %"], rows)


def _integrated(line: Line, subconductors: int) -> Iterator[list[str]]:
    made, model, published = _hybrid(line)
    winds = np.array(WINDS)
    cycles = find_cycles(model, winds, explicit_starts(published, winds, 5), 5)
    for i in np.flatnonzero(cycles.floquet.stability == "stable"):
        orbit = _one(cycles.orbits, i)
        member = int(cycles.member[i])
        state = states(orbit, np.zeros(1))[0, 0]
        state[3:] *= orbit.wind_speed[0]
        settled = integrate(take(model, member), float(orbit.wind_speed[0]), state, change=0.0, longest=CYCLES)
        seen = observation(made, model.shapes[member], member + 1)
        after = 0.5 * np.ptp(settled.history @ seen, axis=0)
        before = half_peak_to_peak(seen.T @ orbit.coefficients[0])
        change = 100.0 * np.abs(after / before - 1.0).max()
        cells = [f"{a:.4f} ({b:.4f})" for a, b in zip(before.tolist(), after.tolist(), strict=True)]
        yield [str(subconductors), str(member + 1), f"{orbit.wind_speed[0]:g}", *cells, f"{change:.3f}"]


def _hybrid(line: Line) -> tuple[Discretization, Any, Any]:
    profile = static_profile((line,))
    made_of = sections((line,), profile)
    system = matrices((line,), profile, made_of)
    made = Discretization((line,), profile, made_of, system)
    model = hybrid_model(made, directional_shapes(system, profile.arc_length, (1, 2)), (1, 2), Analysis())
    return made, take(model, 0), take(with_published_load(made, model), 0)


def _one(orbits: Orbits, index: int) -> Orbits:
    here = slice(index, index + 1)
    return Orbits(orbits.coefficients[here], orbits.angular_frequency[here], orbits.wind_speed[here])


if __name__ == "__main__":
    main()
