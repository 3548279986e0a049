import io
import itertools
from typing import Any
from xml.etree import ElementTree

import pytest
from matplotlib.image import imread

from app import plots
from app.plots.studies import _label, curves

VALUES: dict[str, list[Any]] = {
    "damping.vertical_ratio": [0.0003, 0.0005, 0.0007],
    "span.horizontal_tension_n": [24000.0, 30000.0],
    "span.length_m": [100.0, 126.0],
    "damping.model": ["constant_ratio", "constant_coefficient"],
    "ice.eccentricity_y_m": [1e-3],
}


def study(*axes: str, winds: tuple[float, ...] = (4.0,), failures: int = 0) -> plots.Study:
    found: dict[str, list[dict[str, Any]]] = {"static": [], "limit_cycles": [], "critical_wind_speeds": []}
    for number, values in enumerate(itertools.product(*(VALUES[axis] for axis in axes))):
        point = dict(zip(axes, values, strict=True))
        found["static"].append({**point, "catenary_parameter_m": 1200.0 + number, "sag_m": 1.5 + 0.1 * number})
        place = {**point, "model": "hybrid", "loops": 1}
        for crossing, speed in (("onset", 2.5 + number), ("onset", 2.0 + number), ("restabilization", 1.0)):
            found["critical_wind_speeds"].append({**place, "crossing": crossing, "wind_speed_m_per_s": speed})
        for wind in winds:
            cycle = {**place, "wind_speed_m_per_s": wind, "reduced_wind_speed": wind / 60.0, "kind": "periodic"}
            ratios = {"vertical_ratio": 0.1 * (1 + number), "horizontal_ratio": 0.02 * wind}
            found["limit_cycles"] += [
                {**cycle, **ratios, "stability": "stable"},
                {**cycle, **ratios, "stability": "unstable"},
                {**cycle, "vertical_ratio": None, "horizontal_ratio": None, "stability": "unknown"},
                {**cycle, "vertical_ratio": 0.0, "horizontal_ratio": 0.0, "stability": "stable", "kind": "equilibrium"},
            ]
    found["failures"] = [{**dict.fromkeys(axes, 1.0), "failure": "x"}] * failures
    return plots.Study(axes, 125.0, found)


@pytest.mark.parametrize(
    ("axes", "expected"),
    [
        ((), [4.0 / 60.0]),
        (("damping.vertical_ratio",), [2.0 / 60.0, 3.0 / 60.0, 4.0 / 60.0]),
        (("span.horizontal_tension_n",), [1200.0 / 125.0, 1201.0 / 125.0]),
        (("span.length_m",), [100.0 / 1.5, 126.0 / 1.6]),
        (("damping.model",), VALUES["damping.model"]),
    ],
)
def test_cycles_stand_over_the_ratio_of_the_source(axes: tuple[str, ...], expected: list[Any]) -> None:
    (series,) = curves({"": study(*axes)}, "reduced")
    places = [place for place, _ in series.points]
    assert places == (pytest.approx(expected) if isinstance(expected[0], float) else expected)


@pytest.mark.parametrize("axis", VALUES)
def test_cycles_stand_over_the_values_themselves_if_that_is_wanted(axis: str) -> None:
    (series,) = curves({"": study(axis)}, "parameter")
    assert [place for place, _ in series.points] == VALUES[axis]
    assert _label([axis], "parameter") == axis


def test_each_wind_speed_and_each_line_is_a_series() -> None:
    both = {"twin": study("span.length_m", winds=(4.0, 6.0)), "quad": study("span.length_m", winds=(4.0, 6.0))}
    series = list(curves(both, "reduced"))
    assert [one.name for one in series] == ["twin, 4 m/s", "twin, 6 m/s", "quad, 4 m/s", "quad, 6 m/s"]
    assert len({one.colour for one in series}) == 4


NOTHING = plots.Study((), 125.0, {"static": [], "limit_cycles": [], "critical_wind_speeds": []})


@pytest.mark.parametrize(
    "drawn",
    [*(study(axis) for axis in VALUES), study(), study("span.length_m", winds=(4.0, 5.0), failures=1), NOTHING],
    ids=lambda one: ",".join(one.axes) or "no axis",
)
def test_pictures_are_whole_whatever_was_varied(drawn: plots.Study) -> None:
    svg = plots.study("C11 twin", {"": drawn}, "svg")
    assert ElementTree.fromstring(svg).tag.endswith("svg")
    assert svg == plots.study("C11 twin", {"": drawn}, "svg")
    picture = imread(io.BytesIO(plots.study("C11 twin", {"": drawn}, "png", "parameter")), format="png")
    assert float(picture[..., :3].std()) > 0.01


def test_failed_points_are_counted() -> None:
    whole, broken = study("span.length_m"), study("span.length_m", failures=2)
    assert plots.study("x", {"": whole}, "svg") != plots.study("x", {"": broken}, "svg")
