"""The report as PDF. The renderer reads the document and what this module gives it, no file and no other address."""

from base64 import b64encode
from importlib import resources
from io import BytesIO
from typing import Any

from app import pages, plots
from app.pages.measures import Units
from app.pages.reports.document import pictures, report_html
from app.pages.reports.material import Material
from app.pages.wording import words

_STYLE = "report:style"
_FONT = '@font-face {{ font-family: "Report"; font-weight: {weight}; src: url("report:{weight}"); }}\n'
_TYPES = {"css": "text/css", "svg": "image/svg+xml", "ttf": "font/ttf"}


class NotPrintable(Exception):
    """Raised on a platform for which there is no renderer; the report as HTML is there."""


def report_pdf(material: Material, units: Units) -> bytes:
    """Return the report as PDF; equal material gives equal pages.

    Raises
    ------
    NotPrintable
        If the renderer is not installed.
    """
    try:
        import plutoprint  # noqa: PLC0415 - it is large, and only reports need it
    except ImportError as error:
        raise NotPrintable(words().report.not_printable) from error

    sources = _sources(material)

    class OnlyOwn(plutoprint.ResourceFetcher):
        def fetch_url(self, url: str) -> Any:
            """Return a part of the report, and nothing else."""
            if url not in sources:
                raise plutoprint.Error(f"{url} is no part of the report")
            content, kind = sources[url]
            return plutoprint.ResourceData(content, _TYPES[kind], "utf-8")

    book = plutoprint.Book(plutoprint.PAGE_SIZE_A4)
    book.custom_resource_fetcher = OnlyOwn()
    book.load_html(report_html(material, units, lambda name: f"report:{name}", _STYLE))
    book.set_metadata(plutoprint.PDF_METADATA_TITLE, material.name or words().jobs.unnamed)
    moment = material.made.strftime("%Y-%m-%dT%H:%M:%SZ")
    for when in (plutoprint.PDF_METADATA_CREATION_DATE, plutoprint.PDF_METADATA_MODIFICATION_DATE):
        book.set_metadata(when, moment)
    written = BytesIO()
    book.write_to_pdf_stream(written)
    return written.getvalue()


def report_html_alone(material: Material, units: Units) -> str:
    """Return the report as HTML that refers to nothing outside of itself."""
    sources = _sources(material)

    def inside(url: str) -> str:
        content, kind = sources[url]
        return f"data:{_TYPES[kind]};base64,{b64encode(content).decode()}"

    sources[_STYLE] = _sheet(), "css"
    return report_html(material, units, lambda name: inside(f"report:{name}"), inside(_STYLE))


def _sources(material: Material) -> dict[str, tuple[bytes, str]]:
    """Return everything that the document refers to: its style, the font that plots bring, and the pictures."""
    fonts = plots.fonts()
    rules = "".join(_FONT.format(weight=weight) for weight in fonts).encode()
    made: dict[str, tuple[bytes, str]] = {_STYLE: (rules + _sheet(), "css")}
    for weight, content in fonts.items():
        made[f"report:{weight}"] = content, "ttf"
    found = {**material.found.tables, "orbits": material.orbits}
    for name in pictures(material.found):
        made[f"report:{name}"] = plots.draw(name, found, _facts(material, name), plots.Options()), "svg"
    return made


def _facts(material: Material, picture: str) -> plots.Facts:
    """Return the facts that a picture shows; its title is its own, since the report begins with the line's name."""
    found = material.found
    request = {"line": found.line_here, "analysis": found.analysis}
    title = plots.PICTURES[picture].title
    return plots.facts_of(title, request, found.here["static"], found.tables, found.here["engine_version"])


def _sheet() -> bytes:
    return (resources.files(pages) / "static" / "report.css").read_bytes()
