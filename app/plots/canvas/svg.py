"""Make matplotlib's SVG smaller and readable to others: real text with font families, a title and a description."""

import hashlib
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import groupby
from xml.sax.saxutils import escape

from app.plots.canvas.fonts import SVG_FAMILIES

_NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
_METADATA = re.compile(r" <metadata>.*?</metadata>\n", re.DOTALL)
_COMMENT = re.compile(r"\s*<!--.*?-->", re.DOTALL)
_FAMILY = re.compile(r"font-family: [^;\"]*;? ?")
_HEAD = re.compile(r'<svg [^>]*?width="([\d.]+)pt" height="([\d.]+)pt" viewBox="([^"]*)"[^>]*>')
_PATH = re.compile(r' d="([^"]*)"')
_PLACED = re.compile(r'(?<= )(x|y|transform|width|height)="([^"]*)"')
_USE = re.compile(r'^<use xlink:href="#(\w+)" x="([^"]*)" y="([^"]*)"(?: style="([^"]*)")?/>$')
_NO_TURN = re.compile(r' transform="rotate\(-?0 [^)]*\)"')
_STYLE = re.compile(r' style="([^"]*)"')
_BARE_GROUP = re.compile(r'^<g(?: id="[^"]*")?>$')
_STYLES_END = "</style>"
_SHAPE = re.compile(r'^<path id="(m\w+)" d="([^"]*)"')
_NAME = re.compile(r'id="([mp][0-9a-f]{10}\w*)"')
_OFTEN = 3
_MANY = 12
_PX_PER_PT = 96.0 / 72.0


def tidied(svg: str, title: str, description: str, magnified: float) -> str:
    """Return an SVG of matplotlib with a title and a description, sized in px, and without what no viewer needs.

    Coordinates keep two decimals, which is a hundredth of a point. Styles that occur often become classes, whose names
    differ between pictures, so that several of them can stand in one page.
    """
    svg = _COMMENT.sub("", _METADATA.sub("", svg, count=1))
    svg = _NO_TURN.sub("", _FAMILY.sub("", svg))
    svg = _PATH.sub(lambda found: f' d="{_path(found.group(1))}"', svg)
    svg = _PLACED.sub(lambda found: f'{found[1]}="{_rounded(found[2])}"', svg)
    head, body = svg.split("<defs>", 1)
    lines = [line.strip() for line in ("<defs>" + body).split("\n")]
    lines = _with_shared_styles(list(_without_bare_groups(lines)))
    text = _with_short_names(_with_classes("\n".join(lines)))
    return _HEAD.sub(lambda found: _head(found, title, description, magnified), head, count=1) + text


def _head(found: "re.Match[str]", title: str, description: str, magnified: float) -> str:
    width, height = (f"{_PX_PER_PT * magnified * float(value):.6g}" for value in found.group(1, 2))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" version="1.1" '
        f'width="{width}" height="{height}" viewBox="{_rounded(found.group(3))}" role="img" '
        f'font-family="{SVG_FAMILIES}">\n<title>{escape(title)}</title>\n<desc>{escape(description)}</desc>'
    )


def _path(text: str) -> str:
    """Write a path without the spaces and letters that its grammar does not need."""
    text = _rounded(" ".join(text.split()))
    text = re.sub(r" ?([A-Za-z]) ?", r"\1", text)
    return text.replace("L", " ") if text.startswith("M") and "C" not in text and "Q" not in text else text


def _rounded(text: str) -> str:
    return _NUMBER.sub(lambda found: f"{float(found.group()):.2f}".rstrip("0").rstrip("."), text)


def _without_bare_groups(lines: Sequence[str]) -> Iterator[str]:
    """Leave out groups that only have a name."""
    kept: list[bool] = []
    for line in lines:
        if line.startswith("<g") and not line.endswith("/>"):
            kept.append(_BARE_GROUP.match(line) is None)
            if not kept[-1]:
                continue
        elif line == "</g>" and not kept.pop():
            continue
        yield line


def _with_shared_styles(lines: Sequence[str]) -> list[str]:
    """Draw markers that follow each other and look alike together: few under one style, many along one path."""
    shapes = {match.group(1): match.group(2) for line in lines if (match := _SHAPE.match(line))}
    written: list[str] = []
    for number, ((mark, style), run) in enumerate(groupby(lines, key=_look)):
        found = list(run)
        if style is None or len(found) < _OFTEN:
            written += found
            continue
        places = [match.group(2, 3) for line in found if (match := _USE.match(line))]
        if len(places) < _MANY:
            uses = [f'<use xlink:href="#{mark}" x="{x}" y="{y}"/>' for x, y in places]
            written += [f'<g style="{style}">', *uses, "</g>"]
            continue
        name = f"{mark}n{number}"
        written += [
            f'<marker id="{name}" markerUnits="userSpaceOnUse" overflow="visible">',
            f'<path d="{shapes[mark]}" style="{style}"/>',
            "</marker>",
            f'<path d="M{" ".join(f"{x} {y}" for x, y in places)}" style="fill: none; marker: url(#{name})"/>',
        ]
    return written


def _look(line: str) -> tuple[str, str | None]:
    found = _USE.match(line)
    return (found.group(1), found.group(4)) if found and found.group(4) else ("", None)


def _with_short_names(text: str) -> str:
    """Shorten the names of paths that other elements refer to."""
    prefix = _prefix(text)
    names = {name: f"{prefix}{number}" for number, name in enumerate(dict.fromkeys(_NAME.findall(text)))}
    text = _NAME.sub(lambda found: f'id="{names[found[1]]}"', text)
    return re.sub(r"#([mp][0-9a-f]{10}\w*)", lambda found: "#" + names.get(found[1], found[1]), text)


def _prefix(text: str) -> str:
    """Return a beginning of names that differs between pictures."""
    return "g" + hashlib.sha256(text.encode()).hexdigest()[:4] + "-"


def _with_classes(text: str) -> str:
    """Replace styles that occur often by classes."""
    often = [style for style, count in Counter(_STYLE.findall(text)).most_common() if count >= _OFTEN]
    prefix = _prefix(text)
    classes = {style: f"{prefix}{number}" for number, style in enumerate(often)}
    rules = "".join(f"\n.{name}{{{style.replace(': ', ':').replace('; ', ';')}}}" for style, name in classes.items())
    text = _STYLE.sub(lambda found: f' class="{classes[found[1]]}"' if found[1] in classes else found.group(), text)
    return text.replace(_STYLES_END, f"{rules}\n{_STYLES_END}", 1)
