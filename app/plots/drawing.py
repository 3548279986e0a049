"""What all pictures share: drawing, saving, and the colours and symbols of models and stability."""

import io
import threading
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from typing import Any, Literal

import matplotlib as mpl
from matplotlib.figure import Figure

Row = Mapping[str, Any]
Found = Mapping[str, Sequence[Row]]
Extension = Literal["svg", "png"]
MEDIA_TYPES: Mapping[Extension, str] = {"svg": "image/svg+xml", "png": "image/png"}

COLOURS = {"hybrid": "#0b5394", "finite_element": "#c55a11"}
MARKERS = {"hybrid": "o", "finite_element": "s"}
SIZES = {"hybrid": 7.0, "finite_element": 4.0}  # smaller markers are drawn over larger ones
NAMES = {"hybrid": "hybrid model", "finite_element": "finite element model"}

_DRAWING = threading.Lock()  # threads share matplotlib's fonts and settings
_DOTS_PER_INCH = 130


def drawn(make: Callable[[], Figure], extension: Extension) -> bytes:
    """Draw a figure and return it as a file; equal rows give equal bytes."""
    buffer = io.BytesIO()
    with _DRAWING, _style(), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # names may use any script
        metadata = {"Date": None} if extension == "svg" else None
        make().savefig(buffer, format=extension, dpi=_DOTS_PER_INCH, metadata=metadata)
    return buffer.getvalue()


def _style() -> AbstractContextManager[None]:
    return mpl.rc_context(
        {
            "font.size": 9.0,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "svg.hashsalt": "galloping",
            "text.parse_math": False,  # keep dollar signs in names
        }
    )


def face(model: str, stability: str) -> str:
    """Return a marker's fill: coloured if stable, hollow if unstable, grey if unknown."""
    return {"stable": COLOURS[model], "unstable": "white"}.get(stability, "lightgrey")


def loops_and_models(found: Found) -> tuple[list[int], list[str]]:
    """Return the numbers of loops and the models in the rows, at least one of each, so that there is a panel."""
    rows = [*found["limit_cycles"], *found["critical_wind_speeds"]]
    loops = sorted({row["loops"] for row in rows}) or [1]
    present = {row["model"] for row in rows}
    return loops, [model for model in NAMES if model in present] or ["hybrid"]


def loops_name(count: int) -> str:
    """Return a number of loops in words."""
    return f"{count} loop{'s' if count > 1 else ''} a span"
