"""What surrounds a motion in a picture of the cross-section: the bundle at rest, the design ellipse, other phases."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Ellipse, Patch

from app.plots.canvas.sheet import Sheet
from app.plots.facts import Facts


def draw_surroundings(panel: Axes, facts: Facts, sheet: Sheet) -> None:
    """Draw sub-conductors at rest, the ellipse and the other phases to the scale of the axes: z to the right, y up."""
    palette = sheet.palette
    if facts.ellipse is not None:
        shape = facts.ellipse
        centre = 0.5 * shape.major - shape.below
        panel.add_patch(
            Ellipse((0.0, centre), shape.minor, shape.major, fill=False, color=palette.accent, linestyle="-.", lw=1.2)
        )
    for phase in facts.phases:
        if phase.required:
            place = phase.downwind, phase.up
            panel.add_patch(Circle(place, phase.required, color=palette.bad, alpha=0.14, linewidth=0.0))
        panel.plot([phase.downwind], [phase.up], "o", color=palette.bad, markersize=4.5, zorder=6)
        panel.annotate(
            sheet.write(phase.name),
            (phase.downwind, phase.up),
            xytext=(7, 3),
            textcoords="offset points",
            color=palette.text,
            fontsize="small",
        )
    _bundle_at_rest(panel, facts, sheet)


def _bundle_at_rest(panel: Axes, facts: Facts, sheet: Sheet) -> None:
    up, downwind = np.array(facts.bundle or ((0.0, 0.0),)).T
    panel.plot(downwind, up, "o", color=sheet.palette.text, markersize=3.2, zorder=7)


def surroundings_legend(facts: Facts, palette: Any) -> Iterator[Line2D | Patch]:
    """Yield the legend's entries of what `draw_surroundings` has drawn."""
    yield Line2D([], [], linestyle="none", marker="o", markersize=3.2, color=palette.text, label="conductor at rest")
    if facts.ellipse is not None:
        yield Line2D([], [], linestyle="-.", lw=1.2, color=palette.accent, label="design ellipse (CIGRE TB 322)")
    if facts.phases:
        yield Line2D(
            [], [], linestyle="none", marker="o", markersize=4.5, color=palette.bad, label="other phase at rest"
        )
    if any(phase.required for phase in facts.phases):
        yield Patch(color=palette.bad, alpha=0.14, label="required clearance")


def bounds_of(facts: Facts) -> tuple[float, float, float, float]:
    """Return left, right, bottom and top of what surrounds the motion [m]; zeros if nothing does."""
    boxes = [(0.0, 0.0, 0.0, 0.0)]
    if facts.ellipse is not None:
        half = 0.5 * facts.ellipse.minor
        boxes.append((-half, half, -facts.ellipse.below, facts.ellipse.major - facts.ellipse.below))
    for phase in facts.phases:
        room = phase.required or 0.0
        boxes.append((phase.downwind - room, phase.downwind + room, phase.up - room, phase.up + room))
    left, right, bottom, top = zip(*boxes, strict=True)
    return min(left), max(right), min(bottom), max(top)
