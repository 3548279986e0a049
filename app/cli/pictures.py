"""The command `galloping plot`: pictures of a stored result document, without a service."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import itertools
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from app.cli.console import BAD_INPUT, FAILED, end, notice, placed
from app.cli.inputs import read_json

if TYPE_CHECKING:
    from app.plots import Facts, Options

Orbits = Sequence[Mapping[str, Any]]
Result = Mapping[str, Any]

_SIZE = re.compile(r"^(?P<width>\d+(\.\d+)?)?x(?P<height>\d+(\.\d+)?)?(?P<unit>px|mm)?$")
_DOTS_PER_PX_IN_PRINT = 300.0 / 96.0


@dataclass(frozen=True, slots=True)
class Wanted:
    """What to draw: directory or file, names (all that the result has rows for if empty), look, and the point."""

    output: Path
    names: Sequence[str] = ()
    extension: Literal["svg", "png", "pdf"] = "svg"
    theme: Literal["light", "dark"] = "light"
    size: str | None = None
    point: int | None = None


def plot(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    result: Annotated[Path, typer.Argument(metavar="RESULT.json", help="A result document; - for standard input.")],
    picture: Annotated[
        list[str] | None,
        typer.Option("--picture", metavar="NAME", help="Picture to draw, also several; all with rows if absent."),
    ] = None,
    output: Annotated[
        Path,
        typer.Option(
            metavar="DIR|FILE",
            callback=placed,
            help="Directory for NAME.FORMAT, or the file of one picture; - for stdout.",
        ),
    ] = Path(),
    form: Annotated[Literal["svg", "png", "pdf"] | None, typer.Option("--format", help="Format of the files.")] = None,
    theme: Annotated[Literal["light", "dark"], typer.Option(help="Colours on white, or on black.")] = "light",
    size: Annotated[
        str | None, typer.Option(metavar="WxH", help="Size such as 800x600, 1200x, or 180x120mm (300 dots an inch).")
    ] = None,
    point: Annotated[
        int | None, typer.Option(min=0, help="Point of a study to draw, from 0; the whole study if absent.")
    ] = None,
) -> None:
    """Draw pictures of a result that `analyse --json` or the service has written.

    Orbits and mode shapes, which the document does not hold, are computed anew from its input.
    """
    document = read_json(result)
    if not isinstance(document, dict) or not {"input", "limit_cycles", "static"} <= set(document):
        end(f"{result} is no result document: it lacks input, limit_cycles or static", BAD_INPUT)
    suffix = output.suffix.removeprefix(".")
    known = form or (suffix if suffix in {"svg", "png", "pdf"} else "svg")
    draw_all(document, None, Wanted(output, picture or (), known, theme, size, point))  # type: ignore[arg-type]


def draw_all(result: Result, orbits: Mapping[int, Orbits] | None, wanted: Wanted) -> None:
    """Draw the wanted pictures of a result document into files, and print their names.

    Parameters
    ----------
    result : mapping
        The result document.
    orbits : mapping, optional
        Orbits by point; computed anew if they are needed and absent.
    wanted : Wanted
    """
    from app import plots

    options = _options(wanted)
    whole = wanted.point is None and bool(_axes(result))
    at_point = result if whole else _of_point(result, wanted.point or 0)
    names = wanted.names or plots.drawable(at_point, study=whole)
    for name in names:
        if name not in plots.PICTURES:
            end(f"there is no picture {name!r}; choose of {', '.join(plots.PICTURES)}", BAD_INPUT)
        if whole and not plots.PICTURES[name].whole:
            end(f"{name} is of one point: give --point", BAD_INPUT)
    if not names:
        end("the result has no rows that a picture could show", BAD_INPUT)
    files = list(_files(wanted, names))
    for name, file in zip(names, files, strict=True):
        found, facts = _gathered(at_point, orbits, wanted.point or 0, name)
        _write(plots.draw(name, found, facts, options), file)


def _options(wanted: Wanted) -> "Options":
    from app.plots import Options
    from app.plots.options import PX_PER_MM

    if wanted.size is None:
        return Options(wanted.extension, wanted.theme)
    match = _SIZE.match(wanted.size)
    if match is None or not (match["width"] or match["height"]):
        end(f"--size must be WIDTHxHEIGHT, either may be left out, px or mm; got {wanted.size}", BAD_INPUT)
    factor = PX_PER_MM if match["unit"] == "mm" else 1.0
    width, height = (factor * float(match[name]) if match[name] else None for name in ("width", "height"))
    dots = _DOTS_PER_PX_IN_PRINT if match["unit"] == "mm" else None
    try:
        return Options(wanted.extension, wanted.theme, width, height, dots)
    except ValueError as error:
        end(f"--size: {error}", BAD_INPUT)


def _axes(result: Result) -> list[Mapping[str, Any]]:
    return list((result["input"].get("study") or {"axes": []})["axes"])


def _of_point(result: Result, point: int) -> dict[str, Any]:
    """Return the result document of one point of a study; of another result the document itself."""
    axes = _axes(result)
    if not axes:
        return dict(result)
    names = [axis["parameter"] for axis in axes]
    values = next(itertools.islice(itertools.product(*(axis["values"] for axis in axes)), point, None), None)
    if values is None:
        end(f"the study has no point {point}", BAD_INPUT)

    def here(rows: Any) -> Any:
        return [row for row in rows if all(row.get(n) == v for n, v in zip(names, values, strict=True))]

    tables = {name: here(rows) if _has_rows(rows) else rows for name, rows in result.items()}
    return {**tables, "static": next(iter(tables["static"]), None)}


def _has_rows(rows: Any) -> bool:
    return isinstance(rows, list) and bool(rows) and isinstance(rows[0], dict)


def _gathered(
    result: Result, orbits: Mapping[int, Orbits] | None, point: int, name: str
) -> tuple[dict[str, Any], "Facts"]:
    """Return the rows and the facts that a picture needs."""
    from app import convert, plots

    picture = plots.PICTURES[name]
    found = {table: result.get(table) or [] for table in (*picture.tables, "physics")}
    found |= {"static": result["static"], "failures": result.get("failures") or []} if picture.whole else {}
    request: Mapping[str, Any] = result["input"]
    try:
        if "orbits" in picture.computed:
            found["orbits"] = orbits[point] if orbits is not None else _orbits(request, point)
        if "shapes" in picture.computed:
            found["shapes"] = convert.mode_shapes(request, point)
    except (ArithmeticError, LookupError, ValueError) as error:
        end(f"{name}: what the document does not hold cannot be computed: {error}", FAILED)
    title = str((request.get("line") or {}).get("name") or "galloping")
    static = result["static"] if isinstance(result["static"], dict) else None
    return found, plots.facts_of(title, request, static, found, result.get("engine_version"))


def _orbits(request: Mapping[str, Any], point: int) -> Orbits:
    """Analyse the line of a point again for its orbits, without samples, which have none."""
    from app import convert

    alone = {**request, "analysis": {**request["analysis"], "uncertainty": {"samples": 0}, "risk": False}}
    for item in convert.run(alone):
        if isinstance(item, convert.PointResult) and item.point == point:
            return item.orbits
    raise LookupError(f"there is no point {point}")


def _files(wanted: Wanted, names: Sequence[str]) -> Iterator[Path | None]:
    """Yield the file of each picture; None stands for standard output."""
    if str(wanted.output) == "-" or wanted.output.suffix in {".svg", ".png", ".pdf"}:
        if len(names) > 1:
            end(f"{len(names)} pictures do not go into one file: name one with --picture", BAD_INPUT)
        yield None if str(wanted.output) == "-" else wanted.output
        return
    for name in names:
        yield wanted.output / f"{name}.{wanted.extension}"


def _write(drawn: bytes, file: Path | None) -> None:
    if file is None:
        sys.stdout.buffer.write(drawn)
        return
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(drawn)
    except OSError as error:
        end(f"{file} cannot be written: {error.strerror or error}", BAD_INPUT)
    notice(str(file))
