"""Marks of devices and of pieces of ice on a drawn span, one shape for each kind, and their legend."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from markupsafe import Markup

from app.pages.drawings.svg import Point, element, path, picture
from app.pages.wording import word_for, words

ICE_PIECE = "ice_piece"
_HALF = 4.5
_ARM = 14.0
_SAMPLE = (36.0, 24.0)


def marks(line: Mapping[str, Any], place: Callable[[float], Point]) -> Iterator[Markup]:
    """Yield the marks of a line's pieces of ice and devices; `place` gives the point of the wire at a position [m]."""
    for piece in (line.get("ice") or {}).get("segments") or ():
        yield _mark(ICE_PIECE, _along(piece, place), words().drawings.ice_piece)
    for device in line.get("devices") or ():
        kind = str(device.get("type"))
        if device.get("from_m") is not None and device.get("to_m") is not None:
            yield _mark(kind, _along(device, place), word_for(words().devices, kind))
        elif device.get("position_m") is not None:
            yield _mark(kind, [place(float(device["position_m"]))], word_for(words().devices, kind))


def legend(line: Mapping[str, Any]) -> list[tuple[Markup, str]]:
    """Return the mark of every kind on a line, with its name and how many there are."""
    kinds = Counter(str(device.get("type")) for device in line.get("devices") or ())
    names = {kind: word_for(words().devices, kind) for kind in kinds}
    kinds.update([ICE_PIECE] * len((line.get("ice") or {}).get("segments") or ()))
    names[ICE_PIECE] = words().drawings.ice_piece
    said = words().drawings.counted
    return [(_sample(kind, names[kind]), said.format(name=names[kind], count=count)) for kind, count in kinds.items()]


def _along(stretch: Mapping[str, Any], place: Callable[[float], Point]) -> list[Point]:
    """Return the wire from the start to the end of a stretch, with the bends between."""
    start, stop = float(stretch["from_m"]), float(stretch["to_m"])
    return [place(start + (stop - start) * number / 12.0) for number in range(13)]


def _sample(kind: str, name: str) -> Markup:
    ends = [(4.0, 0.5 * _SAMPLE[1]), (_SAMPLE[0] - 4.0, 0.5 * _SAMPLE[1])]
    stretch = kind in {ICE_PIECE, "airflow_spoiler"}
    at = (
        ends if stretch else [(0.5 * _SAMPLE[0], 0.3 * _SAMPLE[1] if kind == "detuning_pendulum" else 0.5 * _SAMPLE[1])]
    )
    wire = element("path", d=f"M0 {at[0][1]}h{_SAMPLE[0]}", class_="path")
    return picture(_SAMPLE, name, [wire, _mark(kind, at, name)], "drawing sample")


def _mark(kind: str, at: Sequence[Point], name: str) -> Markup:
    """Return the mark of a kind at a point of the wire, or along several."""
    title = element("title", name)
    x, y = at[0]
    if len(at) > 1:
        return element("path", title, d=path(at), class_="ice-piece" if kind == ICE_PIECE else "device stretch")
    if kind == "spacer":
        return element("rect", title, x=x - _HALF, y=y - _HALF, width=2 * _HALF, height=2 * _HALF, class_="device")
    if kind == "torsional_damper":
        turned = [(x, y - 1.5 * _HALF), (x + _HALF, y), (x, y + 1.5 * _HALF), (x - _HALF, y)]
        return element("path", title, d=path(turned, closed=True), class_="device")
    if kind == "detuning_pendulum":
        arm = element("path", d=path([(x, y), (x, y + _ARM)]), class_="device-arm")
        return element("g", title, arm, element("circle", cx=x, cy=y + _ARM, r=_HALF, class_="device"))
    if kind == "interphase_spacer":
        arm = element("path", d=path([(x, y - _ARM), (x, y + _ARM)]), class_="device-arm")
        ends = [element("circle", cx=x, cy=y + end, r=0.6 * _HALF, class_="device") for end in (-_ARM, 0.0, _ARM)]
        return element("g", title, arm, *ends)
    return element("circle", title, cx=x, cy=y, r=_HALF, class_="device")
