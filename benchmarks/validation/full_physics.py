"""Cycles and tensions under full physics beside the reference of theory section 16.1, whose sections are rigid."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import cache

from benchmarks.lines import source_line
from benchmarks.validation.common import REFERENCE, SUBCONDUCTORS, percent, result, table
from engine.result import LimitCycleRow, Result
from engine.spec import Analysis, CrossSection, Line, Model, PhysicsRequest, StaticTwist, with_physics

WINDS = (4.0, 6.0, 10.0)
AT_REST = (0.0, 1.0, 0.0)


def iced_line(subconductors: int, section: CrossSection = CrossSection.RIGID) -> Line:
    """Return a line of the source with coefficients at rest and sections that are said, rigid as in the reference."""
    line = source_line(subconductors)
    line = replace(line, bundle=replace(line.bundle, section=section))
    aerodynamics = replace(line.ice.aerodynamics, at_rest=AT_REST)
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


@cache
def full_results(section: CrossSection = CrossSection.RIGID) -> Mapping[int, Result]:
    """Analyse the source's lines under full physics, by number of sub-conductors; free sections in both models."""
    models = (Model.HYBRID,) if section is CrossSection.RIGID else tuple(Model)
    asked = Analysis(models=models, wind_speeds=WINDS)
    lines = {n: iced_line(n, section) for n in SUBCONDUCTORS}
    return {
        n: result(line, with_physics(line, asked, PhysicsRequest(static_twist=StaticTwist.NEGLECTED)))
        for n, line in lines.items()
    }


def largest_stable(
    subconductors: int,
    loops: int,
    wind_speed: float,
    section: CrossSection = CrossSection.RIGID,
    model: Model = Model.HYBRID,
) -> LimitCycleRow | None:
    """Return the stable cycle of largest vertical amplitude, None where only rest is stable."""
    asked = (model, loops, wind_speed, "periodic", "stable")
    rows = [
        row
        for row in full_results(section)[subconductors].limit_cycles
        if (row.model, row.loops, row.wind_speed_m_per_s, row.kind, row.stability) == asked
    ]
    return max(rows, key=lambda row: row.vertical_m or 0.0, default=None)


def section() -> Iterator[str]:
    """Yield the section's text."""
    rows = []
    for entry in REFERENCE["full_physics"]:
        n, loops = entry["subconductors"], entry["loops"]
        for wind in WINDS:
            found, expected = largest_stable(n, loops, wind), entry[str(wind)]
            key = [n, loops, f"{wind:g}"]
            if found is None or expected is None:
                rows.append(
                    [*key, "at rest" if found is None else "moves", "at rest" if expected is None else "moves", ""]
                )
                continue
            own = (found.vertical_m, found.horizontal_m, found.torsional_rad)
            numbers = [" ".join(f"{value:.4f}" for value in triple) for triple in (own, expected)]
            rows.append([*key, *numbers, percent(own[0] or 0.0, expected[0])])
    yield "## Full physics\n"
    yield (
        "The source's lines with coefficients at rest C_y0 = 0, C_z0 = 1, C_theta0 = 0, relative wind at every\n"
        "sub-conductor, condensed longitudinal inertia and stretching, without static twist: vertical m, horizontal m\n"
        "and torsional rad of the stable cycle, beside Runge-Kutta integration of the unexpanded load until settled\n"
        "(theory section 16.1).\n"
    )
    yield table(["n", "loops", "m/s", "computed", "expected", "difference of the vertical %"], rows)
    yield "\nRange of the horizontal tension H + N of the twin line in one loop, N:\n"
    yield table(["m/s", "computed", "expected"], list(_tensions()))
    yield (
        "\nThe reference is for rigid sections. The same bundles with free sections, the default of full physics, as\n"
        "both models have them, and the range of H + N_i over the sub-conductors. Where the finite element model has\n"
        "no stable motion in two loops, one loop grows in it.\n"
    )
    head = ["n", "loops", "m/s", "rigid", "free, hybrid", "free, finite element", "H + N_i free, N"]
    yield table(head, [_free_row(n, loops, wind) for n in SUBCONDUCTORS[1:] for loops in (1, 2) for wind in WINDS])


def _free_row(subconductors: int, loops: int, wind: float) -> list[object]:
    rigid = largest_stable(subconductors, loops, wind)
    free = [largest_stable(subconductors, loops, wind, CrossSection.FREE, model) for model in Model]
    key = (Model.HYBRID, loops, wind, None if free[0] is None else free[0].branch)
    (tension,) = [
        f"{row.smallest_horizontal_n:.0f} to {row.largest_horizontal_n:.0f}"
        for row in full_results(CrossSection.FREE)[subconductors].tensions
        if (row.model, row.loops, row.wind_speed_m_per_s, row.branch) == key
    ]
    return [subconductors, loops, f"{wind:g}", *(_amplitudes(row) for row in (rigid, *free)), tension]


def _amplitudes(row: LimitCycleRow | None) -> str:
    if row is None:
        return "none stable"
    return f"{row.vertical_m:.4f} {row.horizontal_m:.4f} {row.torsional_rad:.4f}"


def _tensions() -> Iterator[list[str]]:
    for row in full_results()[2].tensions:
        if row.loops == 1 and row.stability == "stable":
            own = (row.smallest_horizontal_n or 0.0, row.largest_horizontal_n or 0.0)
            wind = f"{row.wind_speed_m_per_s:.1f}"
            low, high = REFERENCE["full_physics_tension"][wind]
            yield [wind, f"{own[0]:.0f} to {own[1]:.0f}", f"{low} to {high}"]
