"""Lines to begin with: those of the source, and one as an engineer knows it, with an analysis that takes seconds."""

from copy import deepcopy
from typing import Any

from app.reference.source_lines import EXAMPLE_NAMES, example

DRAKE = "drake"
NAMES = (DRAKE, *EXAMPLE_NAMES)
_DRAKE_LINE: dict[str, Any] = {
    "name": "Twin Drake, 300 m",
    "conductor": {"catalogue": "Drake"},
    "bundle": {"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"},
    "span": {
        "length_m": 300.0,
        "temperature_c": -5.0,
        "everyday": {"temperature_c": 15.0, "share_of_rated_strength": 0.2},
    },
    "ice": {"accretion": {"shape": "crescent", "thickness_m": 0.012}, "aerodynamics": {"catalogue": "c11-40"}},
}
ANALYSIS: dict[str, Any] = {
    "loops": [1, 2],
    "models": ["hybrid", "finite_element"],
    "wind_speeds_m_per_s": {"start": 2.0, "stop": 12.0, "count": 6},
    "amplitude_curves": "reported",
}
"""What pages ask for: both models, and whole curves from the onset to draw."""


def line(name: str) -> dict[str, Any]:
    """Return a line by its name.

    Raises
    ------
    KeyError
        If there is none of that name.
    """
    return deepcopy(_DRAKE_LINE) if name == DRAKE else example(name)
