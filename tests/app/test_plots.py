import io
import math
import re
import warnings
from typing import Any, get_args
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.image import imread

from app import plots
from app.plots import Extension
from app.plots.orbits import _motion

SPEEDS = (4.0, 5.0, 6.0)


def found(speeds: tuple[float, ...] = SPEEDS, loops: tuple[int, ...] = (1, 2)) -> dict[str, list[dict[str, Any]]]:
    rows: dict[str, list[dict[str, Any]]] = {"limit_cycles": [], "critical_wind_speeds": [], "orbits": []}
    for model in ("hybrid", "finite_element"):
        for count in loops:
            critical = {"model": model, "loops": count, "wind_speed_m_per_s": 2.4, "crossing": "onset"}
            rows["critical_wind_speeds"].append(critical)
            for speed in speeds:
                _add_motions(rows, {"model": model, "loops": count, "wind_speed_m_per_s": speed})
    return rows


def _add_motions(rows: dict[str, list[dict[str, Any]]], common: dict[str, Any]) -> None:
    place = {**common, "observed_at_m": 62.94}
    size = 0.05 * common["wind_speed_m_per_s"]
    rest = {"vertical_m": 0.0, "horizontal_m": 0.0, "torsional_rad": 0.0, "branch": None, "stability": "unstable"}
    rows["limit_cycles"].append({**place, **rest})
    shape = {"vertical": [0.0, size, 0.0], "horizontal": [0.1, 0.0, 0.5 * size], "torsional": [0.0, 0.01, 0.0]}
    rows["orbits"].append({"cycle": len(rows["limit_cycles"]), **shape})
    cycle = {"vertical_m": size, "horizontal_m": 0.5 * size, "torsional_rad": 0.01, "branch": 0, "stability": "stable"}
    rows["limit_cycles"].append({**place, **cycle})
    lost = {"vertical_m": None, "horizontal_m": None, "torsional_rad": None, "branch": 1, "stability": "unknown"}
    rows["limit_cycles"].append({**place, **lost})


EMPTY: dict[str, list[dict[str, Any]]] = {"limit_cycles": [], "critical_wind_speeds": [], "orbits": []}


@pytest.mark.parametrize("draw", [plots.amplitude, plots.orbit])
@pytest.mark.parametrize(
    "rows", [found(), found(speeds=(5.0,), loops=(3,)), found(tuple(np.linspace(3, 9, 20))), EMPTY]
)
def test_pictures_are_whole_whatever_was_found(draw: Any, rows: Any) -> None:
    root = ElementTree.fromstring(draw("C11 twin", rows, "svg"))
    assert root.tag.endswith("svg")
    picture = imread(io.BytesIO(draw("C11 twin", rows, "png")), format="png")
    assert picture.ndim == 3
    assert float(picture[..., :3].std()) > 0.01


@pytest.mark.parametrize("draw", [plots.amplitude, plots.orbit])
def test_the_same_rows_make_the_same_picture(draw: Any) -> None:
    assert draw("C11 twin", found(), "svg") == draw("C11 twin", found(), "svg")
    assert draw("C11 twin", found(), "svg") != draw("C11 twin", found(speeds=(4.0, 5.0, 7.0)), "svg")


@pytest.mark.parametrize("title", ["$x^", "50 % $ \\frac{", "\u5bfc\u7ebf <&>", "x" * 200, " "])
def test_no_name_of_a_line_breaks_its_picture(title: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ElementTree.fromstring(plots.amplitude(title, found(), "svg"))
        ElementTree.fromstring(plots.orbit(title, found(), "svg"))


def test_stable_and_unstable_motions_have_other_markers() -> None:
    stable, unstable = found(), found()
    for row in unstable["limit_cycles"]:
        row["stability"] = "unstable"
    assert plots.amplitude("x", stable, "svg") != plots.amplitude("x", unstable, "svg")
    assert plots.orbit("x", stable, "svg") != plots.orbit("x", unstable, "svg")


def test_critical_wind_speeds_are_drawn() -> None:
    without = {**found(), "critical_wind_speeds": []}
    dashed = re.compile(rb"stroke-dasharray")
    assert len(dashed.findall(plots.amplitude("x", found(), "svg"))) > len(
        dashed.findall(plots.amplitude("x", without, "svg"))
    )


def test_the_motion_is_the_sum_of_its_harmonics() -> None:
    phase = np.linspace(0.0, 2.0 * math.pi, 361)
    expected = 0.1 + 0.2 * np.cos(phase) - 0.3 * np.sin(phase) + 0.04 * np.cos(2 * phase) + 0.05 * np.sin(2 * phase)
    np.testing.assert_allclose(_motion([0.1, 0.2, -0.3, 0.04, 0.05]), expected, atol=1e-14)
    np.testing.assert_allclose(_motion([0.7]), np.full(361, 0.7))


def test_there_is_a_media_type_for_each_format() -> None:
    assert plots.MEDIA_TYPES == {"svg": "image/svg+xml", "png": "image/png"}
    assert set(plots.MEDIA_TYPES) == set(get_args(Extension))
