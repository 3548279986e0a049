import re

from app import plots
from tests.app.plots.drawn_motions import motions


def test_critical_wind_speeds_are_drawn() -> None:
    without = {**motions(), "critical_wind_speeds": []}
    dashed = re.compile(rb"stroke-dasharray")
    assert len(dashed.findall(plots.amplitude("x", motions(), "svg"))) > len(
        dashed.findall(plots.amplitude("x", without, "svg"))
    )
