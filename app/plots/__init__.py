"""Pictures of results, the only package that imports matplotlib.

`PICTURES` names them, and `draw` makes a file of one from rows. matplotlib is loaded when the first one is drawn.
Figures are created as objects, without pyplot and its global state.
"""

from app.answers.results import Extension
from app.plots.facts import Facts, Found, facts_of
from app.plots.options import LARGEST_PX, MEDIA_TYPES, SMALLEST_PX, Abscissa, Options, Theme
from app.plots.registry import EDITION, PICTURES, Picture, draw, drawable, fonts

__all__ = [
    "EDITION",
    "LARGEST_PX",
    "MEDIA_TYPES",
    "PICTURES",
    "SMALLEST_PX",
    "Abscissa",
    "Extension",
    "Facts",
    "Found",
    "Options",
    "Picture",
    "Theme",
    "draw",
    "drawable",
    "facts_of",
    "fonts",
]
