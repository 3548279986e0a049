"""Orbits of the hybrid and the finite element model, as the source's Figure 3, and which loops survive one another."""

import io
from collections.abc import Iterator
from dataclasses import replace

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from benchmarks.lines import source_line
from benchmarks.validation.common import ROOT, SUBCONDUCTORS, result, table
from engine.cycles.harmonic_balance import fourier
from engine.result import LimitCycleRow, Result
from engine.spec import Analysis, LongitudinalInertia, LoopCompetition, Model

PICTURE = ROOT / "docs" / "images" / "figure-3.svg"
ASKED = Analysis(wind_speeds=(4.0,), loop_competition=LoopCompetition.CHECKED)
CONDENSED = replace(ASKED, models=(Model.HYBRID,), longitudinal_inertia=LongitudinalInertia.CONDENSED)
STYLES = {Model.HYBRID: "-", Model.FINITE_ELEMENT: "--"}


def section() -> Iterator[str]:
    """Yield the section's text, and draw the picture."""
    results = {n: result(source_line(n), ASKED) for n in SUBCONDUCTORS}
    condensed = {n: result(source_line(n), CONDENSED) for n in SUBCONDUCTORS}
    _draw(results)
    yield "## Orbits of both models at 4 m/s: the source's Figure 3\n"
    yield "![Orbits of both models, one and two loops, one to four sub-conductors](images/figure-3.svg)\n"
    yield (
        "Vertical and horizontal amplitude in m. The hybrid model neglects longitudinal inertia, as the source does; "
        "`condensed` keeps it. The finite element model keeps it too and lets one, two and three loops move together. "
        "The table shows its cycle nearest to the hybrid one, stable or not. At one loop the models agree. At two "
        "loops the vertical and horizontal frequencies lie 0.1 % apart, and the amplitudes follow the detuning. The "
        "neglect of longitudinal inertia shifts the vertical frequency by as much, to the wrong side of the horizontal "
        "one: independent corotational finite elements (OpenSees) side with the condensed model and with the finite "
        "element model. This is an error of the source's hybrid model, which full physics does not have.\n"
    )
    head = ["n", "loops", "hybrid", "hybrid, condensed", "finite element", "its stability", "difference %"]
    yield table(head, [row for n in SUBCONDUCTORS for row in _compared(n, results[n], condensed[n])])
    yield (
        "\nWhich cycle survives? Each cycle that is stable alone in the hybrid model is put into the model in which "
        "one and two loops may move together. The growth factor is the largest Floquet multiplier apart from the "
        "trivial one.\n"
    )
    rows = [
        [n, row.loops, row.stability.value, row.growing_loops, f"{row.growth_per_cycle:.6f}"]
        for n in SUBCONDUCTORS
        for row in results[n].loop_competitions
    ]
    head = ["n", "loops", "stability with both", "loops of the least stable disturbance", "growth factor a cycle"]
    yield table(head, rows)


def _compared(subconductors: int, found: Result, condensed: Result) -> Iterator[list[object]]:
    for row in found.model_comparisons:
        inertia = [r for r in _stable(condensed) if r.loops == row.loops]
        difference = "" if row.amplitude_difference is None else f"{100.0 * row.amplitude_difference:+.2f}"
        yield [
            subconductors,
            row.loops,
            f"{row.hybrid_vertical_m:.4f}, {row.hybrid_horizontal_m:.4f}",
            "; ".join(f"{r.vertical_m:.4f}, {r.horizontal_m:.4f}" for r in inertia),
            f"{row.finite_element_vertical_m:.4f}, {row.finite_element_horizontal_m:.4f}"
            if row.finite_element_vertical_m is not None
            else "none",
            row.finite_element_stability or "",
            difference,
        ]


def _stable(found: Result) -> list[LimitCycleRow]:
    return [row for row in found.limit_cycles if row.kind == "periodic" and row.stability == "stable"]


def _draw(results: dict[int, Result]) -> None:
    """Draw V over W of every pair of a `model_comparisons` row: a column for each line, a row for each loops."""
    figure = Figure(figsize=(11.0, 5.5), layout="constrained")
    axes = figure.subplots(2, len(results), squeeze=False)
    tau = np.linspace(0.0, 2.0 * np.pi, 400)
    for column, (n, found) in enumerate(results.items()):
        for comparison in found.model_comparisons:
            place = axes[comparison.loops - 1, column]
            branches = {Model.HYBRID: comparison.branch, Model.FINITE_ELEMENT: comparison.finite_element_branch}
            for orbit in found.orbits:
                row = found.limit_cycles[orbit.cycle]
                if (row.loops, row.branch) == (comparison.loops, branches[row.model]):
                    wave = fourier(tau, len(orbit.vertical) // 2)
                    name = row.model.value.replace("_", " ")
                    place.plot(wave @ orbit.horizontal, wave @ orbit.vertical, STYLES[row.model], label=name)
            place.set(title=f"n = {n}, {comparison.loops} loop{'s' * (comparison.loops > 1)}")
    for place in axes.flat:
        place.set(xlabel="W [m]", ylabel="V [m]")
        place.grid(alpha=0.3)
    axes[0, 0].legend(fontsize="small")
    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": "figure-3"}):
        figure.savefig(text, format="svg", metadata={"Date": None})
    PICTURE.write_text("\n".join(line.rstrip() for line in text.getvalue().splitlines()) + "\n")
