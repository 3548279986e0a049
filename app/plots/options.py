"""How a picture is wanted: format, theme and size."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from app.answers.results import Extension

Theme = Literal["light", "dark"]
Abscissa = Literal["reduced", "parameter"]
MEDIA_TYPES: Mapping[Extension, str] = {"svg": "image/svg+xml", "png": "image/png", "pdf": "application/pdf"}

SMALLEST_PX = 240
LARGEST_PX = 4096
PX_PER_MM = 96.0 / 25.4


@dataclass(frozen=True, slots=True)
class Options:
    """Format, theme and size of a picture.

    width and height are in px (96 per inch, as in CSS), between `SMALLEST_PX` and `LARGEST_PX`. Without a width the
    picture has its usual one, without a height the one that its panels need at that width. dots_per_px is that of a
    PNG; None stands for 1, or for a sharper picture where no size was asked for. abscissa is for studies over one
    field: ratios as in the source, or values in the field's unit.

    Raises
    ------
    ValueError
        If a length is out of bounds.
    """

    extension: Extension = "svg"
    theme: Theme = "light"
    width: float | None = None
    height: float | None = None
    dots_per_px: float | None = None
    abscissa: Abscissa = "reduced"

    def __post_init__(self) -> None:
        """Check the lengths."""
        for name in ("width", "height"):
            value = getattr(self, name)
            if value is not None and not SMALLEST_PX <= value <= LARGEST_PX:
                raise ValueError(f"{name} must be between {SMALLEST_PX} and {LARGEST_PX} px, got {value:g}")
