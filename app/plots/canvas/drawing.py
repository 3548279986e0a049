"""Draw figures and return them as files; equal rows and options give equal bytes."""

import io
import threading
import warnings
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from app.plots.canvas.fonts import families
from app.plots.canvas.sheet import PT_PER_PX, Sheet, scale_of, settle
from app.plots.canvas.simplify import kept_points
from app.plots.canvas.svg import tidied
from app.plots.canvas.themes import PALETTES
from app.plots.options import Options

_DRAWING = threading.Lock()  # threads share matplotlib's fonts and settings
_TOLERANCE_PX = 0.1
_LONG = 20  # points; shorter lines are not worth simplifying
_MARKED = ("None", "none", " ", "", None)


@dataclass(frozen=True, slots=True)
class About:
    """What a picture is called, what it shows in sentences, and all its other texts that need fonts."""

    title: str
    description: str
    texts: str = ""


def drawn(make: Callable[[], Sheet], options: Options, about: About) -> bytes:
    """Make a sheet and return its figure as a file."""
    buffer = io.BytesIO()
    with _DRAWING, _style(options, about), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # in SVG the viewer's fonts have it
        warnings.filterwarnings("ignore", message="constrained_layout not applied")  # a picture too small for its text
        sheet = make()
        settle(sheet)
        _simplify(sheet.figure)
        _save(sheet.figure, buffer, options, about)
    if options.extension != "svg":
        return buffer.getvalue()
    return tidied(buffer.getvalue().decode(), about.title, about.description, scale_of(options)).encode()


def _save(figure: Figure, buffer: io.BytesIO, options: Options, about: About) -> None:
    """Write the figure by its canvas; `savefig` would draw it twice."""
    metadata = _metadata(options, about)
    if options.extension == "svg":
        FigureCanvasSVG(figure).print_svg(buffer, metadata=metadata)  # type: ignore[no-untyped-call]
    elif options.extension == "png":
        FigureCanvasAgg(figure).print_png(buffer, metadata=metadata)  # type: ignore[no-untyped-call]
    else:
        FigureCanvasPdf(figure).print_pdf(buffer, metadata=metadata)  # type: ignore[no-untyped-call]


def _metadata(options: Options, about: About) -> Mapping[str, Any]:
    if options.extension == "svg":
        return {"Date": None}
    if options.extension == "png":
        return {"Title": about.title.encode("latin-1", "replace").decode("latin-1"), "Software": "galloping"}
    return {"CreationDate": None, "Title": about.title, "Creator": "galloping"}


def _style(options: Options, about: About) -> AbstractContextManager[None]:
    palette = PALETTES[options.theme]
    size = 12.0 * PT_PER_PX
    return mpl.rc_context(
        {
            "font.size": size,
            "font.family": families(f"{about.title} {about.texts}"),
            "axes.labelsize": size,
            "axes.titlesize": size,
            "xtick.labelsize": 0.92 * size,
            "ytick.labelsize": 0.92 * size,
            "legend.fontsize": 0.96 * size,
            "axes.spines.top": False,
            "axes.spines.right": False,
            "axes.facecolor": palette.background,
            "axes.edgecolor": palette.muted,
            "axes.labelcolor": palette.text,
            "axes.titlecolor": palette.text,
            "text.color": palette.text,
            "xtick.color": palette.muted,
            "ytick.color": palette.muted,
            "xtick.labelcolor": palette.text,
            "ytick.labelcolor": palette.text,
            "legend.labelcolor": palette.text,
            "grid.color": palette.grid,
            "grid.linewidth": 0.7,
            "axes.axisbelow": True,
            "svg.hashsalt": "galloping",
            "svg.fonttype": "none",  # text stays text
            "pdf.fonttype": 42,
            "text.parse_math": False,  # keep dollar signs in names
            "path.simplify": False,  # `_simplify` does it, for every format alike
        }
    )


def _simplify(figure: Figure) -> None:
    """Leave out points of lines that lie within a tenth of a px of the rest; markers are left alone."""
    tolerance = _TOLERANCE_PX * figure.dpi / 96.0
    for axes in figure.get_axes():
        for line in axes.get_lines():
            values = np.column_stack([np.asarray(data, dtype=np.float64) for data in line.get_data(orig=False)])
            if len(values) < _LONG or line.get_marker() not in _MARKED or not np.isfinite(values).all():
                continue
            points = np.asarray(line.get_transform().transform(values))
            if np.isfinite(points).all():
                line.set_data(*values[kept_points(points, tolerance)].T)
