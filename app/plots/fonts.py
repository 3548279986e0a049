"""Fonts that come with matplotlib, for documents beside the pictures."""

from pathlib import Path

import matplotlib as mpl

_FILES = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}


def fonts() -> dict[str, bytes]:
    """Return the files of DejaVu Sans (Latin, Greek, Cyrillic, Arabic) by weight."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    return {weight: (folder / name).read_bytes() for weight, name in _FILES.items()}
