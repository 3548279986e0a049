"""Write docs/estimates.md: every value that the engine assumes where a line does not say it, with range and source.

`python -m benchmarks.estimates` writes the page; a test fails if it is out of date.
"""

from collections.abc import Iterator
from pathlib import Path

from benchmarks.validation.common import table
from engine.known import borrowed_coefficients, estimators, everyday, iced_conductor, resolve
from engine.known.densities import IceKind, density_of
from engine.known.estimate import Estimate
from engine.known.wires import Wires

PAGE = Path(__file__).parents[1] / "docs" / "estimates.md"
DRAKE = Wires(402.8e-6, 65.84e-6, 0.02814, 26, 7)
MASS = 1.6281  # kg/m
HEAD = """# Estimates

What the engine assumes where a line does not say it. Each value stands in the result's `assumptions` with its range, in
which the analysis of uncertainty draws its samples. A source is named only if it was opened; otherwise the
sentence says "assumed". ISO 12494 and other standards that are sold could not be opened. `python -m
benchmarks.estimates` writes this page from the code (`engine/known/`)."""


def page() -> str:
    """Return the page's text."""
    return "\n\n".join([HEAD, *_sections()]) + "\n"


def _sections() -> Iterator[str]:
    yield "## Ice"
    kinds = {f"density, {kind.value.replace('_', ' ')}": density_of(kind) for kind in IceKind}
    yield _table(kinds | {"density, neither value nor kind said": iced_conductor.ANY_ICE})
    yield _table({"direction of the thickest point": iced_conductor.GROWS_TO_WINDWARD})
    yield "## Conductor"
    yield "For Drake (26/7, 468.64 mm2, 28.14 mm, 1.6281 kg/m), as if its catalogue row did not say what it says:"
    yield _table(
        {
            "area": estimators.area_of_circle(DRAKE.diameter),
            "modulus over the whole area": estimators.modulus(DRAKE),
            "thermal expansion": estimators.thermal_expansion(DRAKE),
            "torsional rigidity from the stranding": estimators.torsional_rigidity(DRAKE),
            "torsional rigidity from the diameter": estimators.torsional_rigidity_of_diameter(DRAKE.diameter),
            "polar inertia, bare": estimators.polar_inertia(DRAKE, MASS),
            "polar inertia, ice of 0.6 kg/m of unknown shape": estimators.iced_polar_inertia(
                DRAKE.diameter, MASS + 0.6
            ),
        }
    )
    yield (
        "Layers of helical wires that slide freely have GJ = E A r^2 sin^2 a cos a + the sum of G pi d^4/32, with the "
        "area A of aluminium, its mean square radius r^2 and the lay angle a."
    )
    yield "## Damping, air and aerodynamics"
    directions = ("vertical", "horizontal", "torsional")
    yield _table({f"damping ratio, {name}": estimators.damping_ratio(name) for name in directions})
    yield _table({"air density": resolve.AIR})
    yield "Coefficients at rest, of a shape of the catalogue that has none:"
    yield _table(dict(borrowed_coefficients.AT_REST))
    yield "## Tension"
    yield _table(
        {
            "everyday share of rated strength": everyday.USUAL_SHARE,
            "everyday temperature": everyday.USUAL_TEMPERATURE,
            "temperature under ice": everyday.ICING_TEMPERATURE,
        }
    )
    yield (
        "The ruling span is that of the span and its known neighbours, in a range from 0.8 times the shortest to 1.25 "
        "times the longest; an adjacent span that is not said is as long as the span, in a range from half to twice. "
        "The stiffness of the supports along the line follows from both by (A10)."
    )


def _table(estimates: dict[str, Estimate]) -> str:
    head = ["value", "unit", "usual", "lowest", "highest", "source"]
    return table(head, [[name, *_cells(estimate)] for name, estimate in estimates.items()])


def _cells(estimate: Estimate) -> list[str]:
    numbers = (estimate.value, estimate.lowest, estimate.highest)
    return [estimate.unit or "1", *(f"{number:.4g}" for number in numbers), estimate.source]


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
