"""Colours of pictures, light and dark; every pair of text and background has a contrast of 4.5 or more."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Palette:
    """The colours of a theme, and the names of matplotlib's colour maps that suit it.

    series are told apart by people who see red and green alike, too (after Okabe and Ito).
    """

    background: str
    text: str
    muted: str
    grid: str
    unknown: str
    models: Mapping[str, str]
    good: str
    bad: str
    accent: str
    series: Sequence[str]
    colour_map: str
    colour_range: tuple[float, float]


LIGHT = Palette(
    background="#ffffff",
    text="#1c2126",
    muted="#5b646e",
    grid="#d9dde2",
    unknown="#c3c9d0",
    models={"hybrid": "#0b5394", "finite_element": "#b8520f"},
    good="#1d7a46",
    bad="#b3261e",
    accent="#6b3fa0",
    series=("#0b5394", "#b8520f", "#1d7a46", "#8e3a80", "#8a6d00", "#2a7f8e", "#b3261e", "#5a5a5a"),
    colour_map="viridis_r",
    colour_range=(0.15, 1.0),  # without the palest yellow
)
DARK = Palette(
    background="#14181d",
    text="#e8eaed",
    muted="#a4adb8",
    grid="#333b45",
    unknown="#59636f",
    models={"hybrid": "#6db3f2", "finite_element": "#f2a065"},
    good="#62c98c",
    bad="#f28b82",
    accent="#c3a3f0",
    series=("#6db3f2", "#f2a065", "#62c98c", "#dd9ad0", "#e0c353", "#6fcbd9", "#f28b82", "#b8b8b8"),
    colour_map="viridis",
    colour_range=(0.3, 1.0),  # without the darkest blue
)
PALETTES: Mapping[str, Palette] = {"light": LIGHT, "dark": DARK}
