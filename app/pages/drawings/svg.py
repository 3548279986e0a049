"""SVG elements as text, with everything that comes from outside escaped."""

from collections.abc import Iterable, Sequence

from markupsafe import Markup, escape

Point = tuple[float, float]


def element(tag: str, *inside: str, **attributes: object) -> Markup:
    """Return an element; `_` in a name stands for `-`, `class_` for `class`; attributes that are None are left out."""
    named = ((name.rstrip("_").replace("_", "-"), value) for name, value in attributes.items() if value is not None)
    head = "".join(f' {name}="{escape(_number(value))}"' for name, value in named)
    body = "".join(escape(part) for part in inside)
    return Markup(f"<{tag}{head}>{body}</{tag}>")


def picture(size: tuple[float, float], title: str, parts: Iterable[str], class_: str, description: str = "") -> Markup:
    """Return a drawing of a width and height, with its title for those who do not see it."""
    about = (element("title", title), *((element("desc", description),) if description else ()))
    box = f"0 0 {_number(size[0])} {_number(size[1])}"
    return element("svg", *about, *parts, viewBox=box, role="img", aria_label=title, class_=class_)


def path(points: Sequence[Point], *, closed: bool = False) -> str:
    """Return the `d` of a path through points."""
    text = "M" + "L".join(f"{x:.2f} {y:.2f}" for x, y in points)
    return f"{text}Z" if closed else text


def _number(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
