"""The registry of pictures: routes, links of jobs, the OpenAPI document and the command line follow from it by name."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, cast

from app.plots.facts import Facts, Found
from app.plots.options import Options

if TYPE_CHECKING:
    from app.plots.canvas.sheet import Sheet

Maker = Callable[[Found, Facts, Options], "Sheet"]

EDITION = 3
"""Raised when equal rows make another picture than before, so that clients do not keep the old one."""


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture: what it shows, its module in `app.plots`, and the tables whose rows it draws.

    It makes sense where the first of the tables has rows. computed names rows that are no table: orbits (of the stored
    result) and shapes (computed anew). whole pictures show all points of a study, others one point.
    """

    title: str
    module: str
    tables: tuple[str, ...]
    computed: tuple[str, ...] = ()
    whole: bool = False


PICTURES: Mapping[str, Picture] = {
    "verdict": Picture(
        "The verdict: the span and its worst motion", "verdict", ("verdict", "limit_cycles", "clearances"), ("orbits",)
    ),
    "amplitude": Picture(
        "Amplitudes over wind speed",
        "amplitudes",
        ("limit_cycles", "critical_wind_speeds", "bifurcations", "amplitude_curves"),
    ),
    "orbit": Picture(
        "Orbits at the observation point", "orbits", ("limit_cycles", "critical_wind_speeds"), ("orbits",)
    ),
    "modes": Picture("Mode shapes of both models", "modes", ("frequencies",), ("shapes",)),
    "uncertainty": Picture("Galloping and amplitudes over the samples", "uncertainty", ("uncertainty",)),
    "sensitivities": Picture("What each assumed value means", "sensitivities", ("sensitivities",)),
    "tensions": Picture("Tensions during the motions", "tensions", ("tensions",)),
    "clearances": Picture("Smallest distances between phases", "clearances", ("clearances",)),
    "risk": Picture("Hours of galloping a year", "risk", ("risk",)),
    "remedies": Picture("Remedies beside the line as it is", "remedies", ("remedies",)),
    "study": Picture(
        "Amplitudes over the varied field, or a map over two fields",
        "studies",
        ("limit_cycles", "critical_wind_speeds"),
        whole=True,
    ),
}


def draw(name: str, found: Found, facts: Facts, options: Options) -> bytes:
    """Draw a picture of the registry from rows; equal arguments give equal bytes.

    Parameters
    ----------
    name : str
        Name in `PICTURES`.
    found : mapping
        Rows by table, at least those of the picture's tables; tables that are absent count as empty.
    facts : Facts
    options : Options
    """
    from app.plots.canvas.drawing import About, drawn  # noqa: PLC0415 - matplotlib loads slowly, and the API starts without it

    picture = PICTURES[name]
    make = cast("Maker", import_module(f"{__package__}.{picture.module}").picture)
    names = " ".join(phase.name for phase in facts.phases)
    about = About(f"{facts.title}: {picture.title}", " ".join(filter(None, facts.footer)), names)
    return drawn(lambda: make(found, facts, options), options, about)


def drawable(found: Mapping[str, Any], *, study: bool) -> list[str]:
    """Return the names of the pictures that the rows of a result document make sense for."""
    return [
        name
        for name, picture in PICTURES.items()
        if found.get(picture.tables[0]) and (picture.whole if study else name != "study")
    ]


def fonts() -> dict[str, bytes]:
    """Return the font files of documents beside pictures, by weight."""
    from app.plots.canvas.fonts import font_files  # noqa: PLC0415 - as above

    return font_files()
