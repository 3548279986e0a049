"""Fonts: which families write a text, and what to do about characters that no installed font has.

matplotlib shapes Arabic and orders mixed directions itself (libraqm). In SVG the text stays text, and the viewer does
both with its own fonts.
"""

import logging
from collections.abc import Iterable, Sequence
from functools import lru_cache
from pathlib import Path

import matplotlib as mpl
from matplotlib import font_manager

BASE = "DejaVu Sans"
"""Comes with matplotlib; has the Latin, Greek, Cyrillic and Arabic scripts."""
PREFERRED = (
    "Noto Sans CJK SC",
    "Noto Sans CJK JP",
    "Source Han Sans SC",
    "WenQuanYi Micro Hei",
    "WenQuanYi Zen Hei",
    "Droid Sans Fallback",
    "Noto Sans",
)
SVG_FAMILIES = (
    "'DejaVu Sans', 'Noto Sans', 'Segoe UI', Arial, 'Noto Sans CJK SC', 'Microsoft YaHei', 'PingFang SC', "
    "'WenQuanYi Micro Hei', sans-serif"
)
_FILES = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}
MISSING = "\u2026"

logging.getLogger("matplotlib.font_manager").setLevel(logging.ERROR)  # a fallback without a bold face is no news


def families(text: str) -> list[str]:
    """Return the families that together write a text: the base font, and others only for what it lacks."""
    chosen = [BASE]
    lacking = _needed(text) - _characters(BASE)
    for family in _candidates() if lacking else ():
        gained = lacking & _characters(family)
        if gained:
            chosen.append(family)
            lacking -= gained
        if not lacking:
            break
    return chosen


def writable(text: str, chosen: Sequence[str]) -> str:
    """Replace each run of characters that the families lack by one ellipsis."""
    known = set().union(*(_characters(family) for family in chosen))
    written: list[str] = []
    for character in text:
        if character.isspace() or not character.isprintable() or ord(character) in known:
            written.append(character)
        elif not written or written[-1] != MISSING:
            written.append(MISSING)
    return "".join(written)


def font_files() -> dict[str, bytes]:
    """Return the files of DejaVu Sans (Latin, Greek, Cyrillic, Arabic) by weight."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    return {weight: (folder / name).read_bytes() for weight, name in _FILES.items()}


def _needed(text: str) -> set[int]:
    return {ord(character) for character in text if character.isprintable() and not character.isspace()}


def _candidates() -> Iterable[str]:
    """Return the installed families, the preferred ones first."""
    installed = _installed()
    return [*(name for name in PREFERRED if name in installed), *sorted(installed - {*PREFERRED, BASE})]


@lru_cache(maxsize=1)
def _installed() -> set[str]:
    """Return the installed families, with those that were installed after matplotlib listed the fonts."""
    manager = font_manager.fontManager
    listed = {entry.fname for entry in manager.ttflist}
    for path in sorted(set(font_manager.findSystemFonts()) - listed):
        try:
            manager.addfont(path)
        except (OSError, RuntimeError, ValueError):  # not a font that FreeType reads
            continue
    own = Path(mpl.get_data_path())  # beside the base font: fonts for formulas, and one that has a box for everything
    return {
        entry.name
        for entry in manager.ttflist
        if Path(entry.fname).exists() and (entry.name == BASE or own not in Path(entry.fname).parents)
    }


@lru_cache(maxsize=64)
def _characters(family: str) -> frozenset[int]:
    """Return the characters of a family, none if it is not installed."""
    try:
        path = font_manager.findfont(font_manager.FontProperties(family=[family]), fallback_to_default=False)
        return frozenset(font_manager.get_font(path).get_charmap())
    except (OSError, RuntimeError, ValueError):
        return frozenset()
