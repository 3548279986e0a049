"""Pictures of results, the only package that imports matplotlib.

Figures are created as objects, without pyplot and its global state.
"""

from app.plots.amplitudes import amplitude
from app.plots.drawing import MEDIA_TYPES, Extension
from app.plots.fonts import fonts
from app.plots.modes import modes
from app.plots.orbits import orbit
from app.plots.studies import Abscissa, Study, study

__all__ = ["MEDIA_TYPES", "Abscissa", "Extension", "Study", "amplitude", "fonts", "modes", "orbit", "study"]
