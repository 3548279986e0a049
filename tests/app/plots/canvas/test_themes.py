import pytest

from app.plots.canvas.themes import DARK, LIGHT, Palette


def luminance(colour: str) -> float:
    """Return the relative luminance of WCAG 2."""
    parts = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.03928 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


@pytest.mark.parametrize("palette", [LIGHT, DARK])
def test_text_and_curves_stand_out_from_the_background(palette: Palette) -> None:
    texts = [palette.text, palette.muted, palette.good, palette.bad, palette.accent]
    for colour in (*texts, *palette.models.values(), *palette.series):
        light, dark = sorted((luminance(colour), luminance(palette.background)), reverse=True)
        assert (light + 0.05) / (dark + 0.05) >= 4.5, colour
