"""The source's Figures 4 to 9 on its four lines: plots, and the source's statements compared with the results."""

import cmath
import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from app import convert
from app.plots import Options
from app.plots.studies import Study, curves, drawn_together
from app.reference.source_lines import EXAMPLE_NAMES
from app.reference.source_studies import study_request
from benchmarks.validation.common import ROOT, table
from benchmarks.validation.statements import (
    BUNDLES,
    LINES,
    Curve,
    Curves,
    Statement,
    alike,
    grows,
    horizontal_over_vertical,
    monotone,
    single_is_lowest,
    steeper_at_first,
    twin_is_smaller,
)

TURNS_DEG = (0, 60, 130, 180, 230, 300)
IMAGES = ROOT / "docs" / "images"


def section() -> Iterator[str]:
    """Yield the section's text, and draw the pictures that it shows."""
    yield "## The source's studies: Figures 4 to 9\n"
    yield (
        "Each figure is a preset of the command line, for example `galloping example --study figure-4 c11-twin`. The "
        "pictures are the service's own, with four lines in one. Hybrid model, stable cycles, wind speed 4 m/s where "
        "it does not vary; w is the iced weight of a sub-conductor in the span. The source prints its figures without "
        "numbers, so only its statements can be compared."
    )
    for name, (title, statements) in FIGURES.items():
        found = _studies(name)
        _draw(name, title, found)
        yield f"\n### {title}\n"
        yield f"![{title}](images/{name}.svg)\n"
        shown = _curves(found)
        rows = [[text, *_verdict(check(shown))] for text, check in statements]
        yield table(["the source", "here", ""], rows)
    yield (
        "\nAt 270 degrees the motion is horizontal here, not vertical as the source says. The source gives the "
        "position of the ice's mass at 40 degrees only, and the figures above turn it with the ice. The table shows "
        "that this choice is not the cause:\n"
    )
    yield table(["mass turned by, deg", "onset m/s", "direction", "A_z / A_y at 6 m/s"], list(_turned()))
    title = "Twin bundle over tension and span"
    _draw("tension-and-span", title, {"twin": _study("tension-and-span", "c11-twin")})
    yield f"\n### {title}\n\nTwo axes make a map (`--study tension-and-span`).\n"
    yield f"![{title}](images/tension-and-span.svg)"


def _verdict(checked: tuple[str, bool]) -> tuple[str, str]:
    text, agrees = checked
    return text, "agrees" if agrees else "**differs**"


def _studies(name: str) -> Mapping[str, Study]:
    return {line.removeprefix("c11-"): _study(name, line) for line in EXAMPLE_NAMES}


def _study(name: str, line: str) -> Study:
    """Run a preset as `galloping analyse` does."""
    request = study_request(name, line)
    document = convert.read(request).model_dump(mode="json", by_alias=True)
    points = [item for item in convert.run(document) if isinstance(item, convert.PointResult)]
    found = {t: [{**p.axes, **row} for p in points for row in p.tables[t]] for t in convert.TABLES}
    static = [{**p.axes, **p.static} for p in points if p.static]
    axes = [axis["parameter"] for axis in request.get("study", {"axes": []})["axes"]]
    return Study(axes, request["line"]["span"]["length_m"], {**found, "static": static})


def _draw(name: str, title: str, found: Mapping[str, Study]) -> None:
    (IMAGES / f"{name}.svg").write_bytes(drawn_together(title, found, Options()))


def _curves(found: Mapping[str, Study]) -> list[Curve]:
    result = []
    for curve in curves(found, "reduced"):
        for loops in sorted({row["loops"] for _, row in curve.points}):
            points = sorted(
                (place, row["vertical_ratio"], row["horizontal_ratio"])
                for place, row in curve.points
                if row["loops"] == loops and row["stability"] == "stable"
            )
            result.append(Curve(curve.name, loops, *np.array(points).T))
    return result


def _turned() -> Iterator[list[object]]:
    """Yield the first onset and a stable cycle of the single conductor at 270 degrees, the mass of its ice turned."""
    request = study_request("figure-6", "c11-single")
    request["analysis"]["wind_speeds_m_per_s"] = [6.0]
    ice = request["line"]["ice"]
    place = complex(ice["eccentricity_y_m"], ice["eccentricity_z_m"])
    for turn in TURNS_DEG:
        turned = place * cmath.exp(1j * math.radians(turn - 230.0))
        ice |= {"eccentricity_y_m": turned.real, "eccentricity_z_m": turned.imag}
        (point,) = (item for item in convert.run(request) if isinstance(item, convert.PointResult))
        onset = next(iter(point.tables["critical_wind_speeds"]), None)
        stable = [r for r in point.tables["limit_cycles"] if r["kind"] == "periodic" and r["stability"] == "stable"]
        ratio = f"{stable[-1]['horizontal_m'] / stable[-1]['vertical_m']:.3g}" if stable else "no stable cycle"
        yield [
            turn,
            f"{onset['wind_speed_m_per_s']:.3f}" if onset else "none",
            onset["direction"] if onset else "",
            ratio,
        ]


def _bundles_at_270(_: Curves) -> tuple[str, bool]:
    """Return the lowest critical wind speeds at 270 degrees with the source's damping."""
    onsets = {}
    for name, study in _studies("figure-6").items():
        speeds = [
            row["wind_speed_m_per_s"] for row in study.found["critical_wind_speeds"] if row["crossing"] == "onset"
        ]
        onsets[name] = min(speeds)
    text = ", ".join(f"{name} {speed:.2f}" for name, speed in onsets.items())
    return f"unstable from, m/s: {text}", onsets["single"] < 4.0 < min(onsets[name] for name in BUNDLES)


FIGURES: Mapping[str, tuple[str, Sequence[Statement]]] = {
    "figure-4": (
        "Figure 4: amplitude over critical wind speed, 40 degrees",
        [
            ("A falls as U_c rises", monotone(("both",), -1)),
            ("the single conductor has the lowest A at a given U_c", single_is_lowest),
            ("one loop: A_y dominates", horizontal_over_vertical(1, LINES, above=False)),
            ("two loops: A_z is the larger part, bundles", horizontal_over_vertical(2, BUNDLES, above=True)),
            (
                "two loops: A_z is the larger part, single",
                horizontal_over_vertical(2, ("single",), above=True),
            ),
        ],
    ),
    "figure-5": (
        "Figure 5: amplitude over critical wind speed, 270 degrees",
        [
            ("single conductor unstable though Den Hartog calls it stable; bundles stable", _bundles_at_270),
            ("A falls as U_c rises, single conductor", monotone(("both",), -1, ("single",))),
            ("more rapidly at the lowest U_c", steeper_at_first),
        ],
    ),
    "figure-6": (
        "Figure 6: amplitudes over wind speed, 270 degrees",
        [
            ("A_y and A_z grow with the wind, single conductor", monotone(("vertical", "horizontal"), 1, ("single",))),
            ("A_y is much larger than A_z", horizontal_over_vertical(1, ("single",), above=False)),
        ],
    ),
    "figure-7": (
        "Figure 7: amplitudes over wind speed, 40 degrees",
        [
            ("A_y and A_z grow with the wind", monotone(("vertical", "horizontal"), 1)),
            ("one loop: A_y is much larger than A_z", horizontal_over_vertical(1, LINES, above=False)),
            ("two loops: A_z is larger, bundles", horizontal_over_vertical(2, BUNDLES, above=True)),
            ("two loops: the single conductor is the exception", horizontal_over_vertical(2, ("single",), above=False)),
            ("the number of conductors hardly affects A_y (one loop)", alike(1, "vertical", 0.1)),
            ("the number of conductors hardly affects A_z (two loops)", alike(2, "horizontal", 0.1)),
        ],
    ),
    "figure-8": (
        "Figure 8: amplitudes over tension ratio",
        [
            ("A_y and A_z tend to grow with H", grows),
            ("two loops: twin somewhat smaller than triple and quad, most at large H", twin_is_smaller),
        ],
    ),
    "figure-9": (
        "Figure 9: amplitudes over span ratio",
        [
            ("A_y and A_z tend to grow with L_x / s_a", grows),
            ("two loops: twin somewhat smaller than triple and quad", twin_is_smaller),
        ],
    ),
}
