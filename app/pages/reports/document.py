"""The report as HTML: verdict, line, assumptions, results, method and its limits."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from app.pages.drawings.spans import SpanDrawing, span_drawing
from app.pages.findings import Findings
from app.pages.frame import rendered
from app.pages.measures import Units
from app.pages.reports.material import Material
from app.pages.result_parts import findings_parts
from app.pages.wording import words

_PICTURES = {"amplitude": "limit_cycles", "orbit": "limit_cycles", "remedies": "remedies"}
_MOST_ROWS = 60  # of each table; the downloads have the rest


def report_html(material: Material, units: Units, picture: Callable[[str], str], style: str) -> str:
    """Return the whole document.

    Parameters
    ----------
    material : Material
    units : Units
        Units of the reader.
    picture : callable
        Returns the address of a picture, by its name among the `pictures`.
    style : str
        Address of the style sheet.
    """
    found = material.found
    return rendered(
        "report.html",
        material=material,
        found=found,
        units=units,
        words=words(),
        style=style,
        pictures=[(name, picture(name)) for name in pictures(found)],
        span=_span(material, units),
        given=list(_given(found.line_here)) if not found.rows("assumptions") else [],
        most_rows=_MOST_ROWS,
        **findings_parts(found, units, material.motions),
    )


def pictures(found: Findings) -> list[str]:
    """Return the names of the pictures that a report shows: those with rows to draw."""
    return [name for name, table in _PICTURES.items() if found.rows(table)]


def _span(material: Material, units: Units) -> SpanDrawing | None:
    """Return the drawing of the span at rest; None for sections and where there is no static state."""
    found = material.found
    if found.line.get("section") is not None or not found.here["static"]:
        return None
    return span_drawing(found.line_here, found.here["static"]["sag_m"], 0.0, units)


def _given(part: object, path: str = "") -> Iterator[tuple[str, str]]:
    """Yield the values of an explicit line, each with its path; the unit is the end of the path."""
    if isinstance(part, Mapping):
        for name, value in part.items():
            yield from _given(value, f"{path}.{name}" if path else name)
    elif isinstance(part, Sequence) and not isinstance(part, str):
        if all(isinstance(value, int | float) for value in part):
            yield path, ", ".join(f"{value:.6g}" for value in part)
        else:
            for number, value in enumerate(part):
                yield from _given(value, f"{path}.{number}")
    elif part is not None:
        yield path, f"{part:.6g}" if isinstance(part, float) else str(part)
