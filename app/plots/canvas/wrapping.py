"""Break text into lines by the width that it takes, not by the number of its characters."""

import unicodedata
from collections.abc import Iterator
from functools import lru_cache

from matplotlib import font_manager
from matplotlib.ft2font import LoadFlags

from app.plots.canvas.fonts import BASE

_WIDE = frozenset("WF")  # of East Asian scripts: as wide as high
_MEASURED = 100.0  # size at which the base font is measured
_FIXED_POINT = 65536.0  # FreeType's unit of an advance


def width_of(text: str) -> float:
    """Return the width of a line of text in the base font, about that of others, in units of the font's size."""
    return sum(map(_ems, text))


def wrapped(text: str, widest: float, most_lines: int) -> list[str]:
    """Return the lines of a text, each at most so wide [font sizes]; an ellipsis ends what does not fit."""
    lines: list[str] = []
    line = ""
    for piece in _pieces(" ".join(text.split()), widest):
        if line and width_of(line + piece.rstrip()) > widest:
            lines.append(line.rstrip())
            line = ""
        line += piece.lstrip() if not line else piece
    lines.append(line.rstrip())
    if len(lines) <= most_lines:
        return lines
    return [*lines[: most_lines - 1], shortened(" ".join(lines[most_lines - 1 :]), widest)]


def shortened(text: str, widest: float) -> str:
    """Return a text that is at most so wide [font sizes], with an ellipsis in place of its end if it was wider."""
    if width_of(text) <= widest:
        return text
    kept = ""
    for character in text:
        if width_of(kept + character) > widest - 1.0:
            break
        kept += character
    return kept.rstrip() + "\u2026"


@lru_cache(maxsize=4096)
def _ems(character: str) -> float:
    if unicodedata.combining(character):
        return 0.0
    if unicodedata.east_asian_width(character) in _WIDE:
        return 1.0
    font = font_manager.get_font(font_manager.findfont(BASE))
    font.set_size(_MEASURED, 72.0)
    return font.load_char(ord(character), flags=LoadFlags.NO_HINTING).linearHoriAdvance / _FIXED_POINT / _MEASURED


def _pieces(text: str, widest: float) -> Iterator[str]:
    """Yield what a line may end after: words with the space behind them, wide characters, parts of long words."""
    piece = ""
    for character in text:
        piece += character
        wide = unicodedata.east_asian_width(character) in _WIDE
        if character == " " or wide or width_of(piece) > widest - 1.0:
            yield piece
            piece = ""
    if piece:
        yield piece
