"""Statements of the source about its Figures 4 to 9, checked on computed curves."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import FloatArray

BUNDLES = ("twin", "triple", "quad")
LINES = ("single", *BUNDLES)


@dataclass(frozen=True, slots=True)
class Curve:
    """Stable cycles of one line and number of loops in ascending order of the abscissa: A_y/s_a and A_z/s_a."""

    line: str
    loops: int
    abscissa: FloatArray
    vertical: FloatArray
    horizontal: FloatArray

    @property
    def both(self) -> FloatArray:
        """A/s_a."""
        return np.hypot(self.vertical, self.horizontal)


Curves = Sequence[Curve]
Check = Callable[[Curves], tuple[str, bool]]
Statement = tuple[str, Check]


def _of(shown: Curves, loops: int, lines: Sequence[str] = LINES) -> list[Curve]:
    return [curve for curve in shown if curve.loops == loops and curve.line in lines]


def monotone(quantities: Sequence[str], sign: int, lines: Sequence[str] = LINES) -> Check:
    """Check that quantities rise (1) or fall (-1) along every curve; name the curves where they do not."""
    word = {1: "rises", -1: "falls"}[sign]

    def check(shown: Curves) -> tuple[str, bool]:
        mine = [curve for curve in shown if curve.line in lines]
        wrong = [
            f"{curve.line}, {curve.loops} loop{'s' * (curve.loops > 1)}"
            for curve in mine
            if any((sign * np.diff(getattr(curve, quantity)) <= 0.0).any() for quantity in quantities)
        ]
        text = f"{word} along {len(mine) - len(wrong)} of {len(mine)} curves"
        return text + (f" (not: {'; '.join(wrong)})" if wrong else ""), not wrong

    return check


def grows(shown: Curves) -> tuple[str, bool]:
    """Check that A_y and A_z are larger at the end of every curve than at its start, and count steps back."""
    pairs = [values for curve in shown for values in (curve.vertical, curve.horizontal)]
    growth = np.array([values[-1] / values[0] for values in pairs])
    back = sum(bool((np.diff(values) < 0.0).any()) for values in pairs)
    growths = f"last over first value {growth.min():.3g} to {growth.max():.3g}"
    text = f"{growths}; falls somewhere on {back} of {len(pairs)} curves"
    return text, bool((growth > 1.0).all())


def horizontal_over_vertical(loops: int, lines: Sequence[str], *, above: bool) -> Check:
    """Check that A_z / A_y lies above or below 1 along some curves."""

    def check(shown: Curves) -> tuple[str, bool]:
        ratio = np.concatenate([curve.horizontal / curve.vertical for curve in _of(shown, loops, lines)])
        agrees = bool((ratio > 1.0).all() if above else (ratio < 1.0).all())
        return f"A_z / A_y from {ratio.min():.3g} to {ratio.max():.3g}", agrees

    return check


def single_is_lowest(shown: Curves) -> tuple[str, bool]:
    """Compare the single conductor's A with that of the bundles, interpolated to the same critical speed."""
    parts, agrees = [], True
    for loops in (1, 2):
        (single,) = _of(shown, loops, ("single",))
        others = _of(shown, loops, BUNDLES)
        common = np.all(
            [(single.abscissa >= o.abscissa[0]) & (single.abscissa <= o.abscissa[-1]) for o in others], axis=0
        )
        place = single.abscissa[common]
        least = np.min([np.interp(place, other.abscissa, other.both) for other in others], axis=0)
        lowest = single.both[common] < least
        agrees &= bool(lowest.all())
        parts.append(f"{loops} loop{'s' * (loops > 1)}: at {lowest.sum()} of {lowest.size} critical speeds")
    return "; ".join(parts), agrees


def steeper_at_first(shown: Curves) -> tuple[str, bool]:
    """Compare the fall of the single conductor's A at both ends of the abscissa."""
    (single,) = _of(shown, 1, ("single",))
    slope = -np.diff(single.both) / np.diff(single.abscissa)
    text = f"slope {slope[0]:.3g} at the lowest, {slope[-1]:.3g} at the highest critical speed"
    return text, bool(slope[0] > slope[-1])


def alike(loops: int, quantity: str, most: float) -> Check:
    """Check that lines of different numbers of sub-conductors differ little."""

    def check(shown: Curves) -> tuple[str, bool]:
        bundles = np.array([getattr(curve, quantity) for curve in _of(shown, loops, BUNDLES)])
        every = np.array([getattr(curve, quantity) for curve in _of(shown, loops)])
        among, whole = (float((v.max(axis=0) / v.min(axis=0) - 1.0).max()) for v in (bundles, every))
        return f"at most {among:.1%} among bundles, {whole:.1%} with the single conductor", among < most

    return check


def twin_is_smaller(shown: Curves) -> tuple[str, bool]:
    """Compare the twin with the smaller of triple and quad in two loops, at both ends of the abscissa."""
    (twin,), others = _of(shown, 2, ("twin",)), _of(shown, 2, ("triple", "quad"))
    parts, agrees = [], True
    for symbol, name in (("A_y", "vertical"), ("A_z", "horizontal")):
        change = getattr(twin, name) / np.min([getattr(other, name) for other in others], axis=0) - 1.0
        agrees &= bool(change[-1] < 0.0)
        parts.append(f"{symbol} {change[0]:+.1%} at the lowest, {change[-1]:+.1%} at the highest")
    return "; ".join(parts), agrees
