"""Write docs/validation.md. `make validation` writes the whole page; names of sections write only those anew."""

import argparse
from collections.abc import Callable, Iterator, Mapping

from benchmarks.validation import (
    bifurcations,
    changes_of_state,
    completeness,
    critical_wind_speeds,
    device_placement,
    direct_integration,
    free_sections,
    frequencies,
    full_physics,
    internal_resonance,
    interphase_spacers,
    limit_cycles,
    longitudinal_inertia,
    model_comparison,
    quasi_periodic,
    relative_wind,
    span_sections,
    static_state,
    static_twist,
    stretching,
    studies,
    tables,
)
from benchmarks.validation.common import ROOT

PAGE = ROOT / "docs" / "validation.md"

HEADER = """# Validation

`make validation` computes every figure on this page (benchmarks/validation/, one module a section). Unless a section
says otherwise, the lines are those of the source's Table 1 with one to four sub-conductors (n), constant damping
coefficient, exact closure and ten elements. [Conventions](conventions.md#sections-of-the-theory) lists the sections of
the theory that this page names; [nomenclature](nomenclature.md) explains symbols."""

SECTIONS: Mapping[str, Callable[[], Iterator[str]]] = {
    "frequencies": frequencies.section,
    "longitudinal_inertia": longitudinal_inertia.section,
    "free_sections": free_sections.section,
    "internal_resonance": internal_resonance.section,
    "critical_wind_speeds": critical_wind_speeds.section,
    "limit_cycles": limit_cycles.section,
    "direct_integration": direct_integration.section,
    "bifurcations": bifurcations.section,
    "completeness": completeness.section,
    "model_comparison": model_comparison.section,
    "quasi_periodic": quasi_periodic.section,
    "studies": studies.section,
    "tables": tables.section,
    "relative_wind": relative_wind.section,
    "static_state": static_state.section,
    "changes_of_state": changes_of_state.section,
    "span_sections": span_sections.section,
    "static_twist": static_twist.section,
    "stretching": stretching.section,
    "full_physics": full_physics.section,
    "full_completeness": completeness.full_section,
    "interphase_spacers": interphase_spacers.section,
    "device_placement": device_placement.section,
}


def main() -> None:
    """Compute the sections asked for and put them on the page; the others stay as they are."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=f"all, or some of: {', '.join(SECTIONS)}")
    wanted = parser.parse_args().sections or list(SECTIONS)
    if unknown := set(wanted) - set(SECTIONS):
        parser.error(f"there are no sections {', '.join(sorted(unknown))}")
    new = {}
    for name in wanted:
        print(name, flush=True)
        new[name] = "\n".join(SECTIONS[name]())
    written = _written() | new
    texts = [f"{_mark(name)}\n{written[name]}" for name in SECTIONS if name in written]
    PAGE.write_text("\n\n".join([HEADER, *texts]) + "\n")


def _written() -> dict[str, str]:
    """Return the sections that the page holds, by name."""
    pieces = PAGE.read_text().split("\n\n<!-- section ")[1:]
    return {name: text.rstrip("\n") for name, text in (piece.split(" -->\n", 1) for piece in pieces)}


def _mark(name: str) -> str:
    return f"<!-- section {name} -->"


if __name__ == "__main__":
    main()
