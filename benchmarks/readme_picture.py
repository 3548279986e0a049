"""Draw the picture of the README: `python -m benchmarks.readme_picture`, some seconds."""

from pathlib import Path

from app import convert, plots
from app.reference.source_lines import example

PICTURE = Path(__file__).parents[1] / "docs" / "images" / "c11-twin-amplitude.svg"
ASKED = {
    "physics": "source",
    "loops": [1, 2, 3],
    "wind_speeds_m_per_s": {"start": 3.0, "stop": 10.0, "count": 8},
    "amplitude_curves": "reported",
}


def main() -> None:
    """Analyse the source's twin bundle with both models and write the picture of its amplitudes."""
    request = convert.read({"line": example("c11-twin"), "analysis": ASKED}).kept()
    (point,) = (item for item in convert.run(request) if isinstance(item, convert.PointResult))
    facts = plots.facts_of("C11 twin, 126 m", request, point.static, point.tables, point.engine_version)
    PICTURE.write_bytes(plots.draw("amplitude", point.tables, facts, plots.Options()))


if __name__ == "__main__":
    main()
