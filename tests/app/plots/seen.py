"""What tests look at in a sheet."""

from typing import Any

from app.plots.canvas.sheet import Sheet


def figure_of(sheet: Sheet) -> Any:
    """Return the figure of a sheet; the types of matplotlib do not know what its lines and patches hold."""
    return sheet.figure
