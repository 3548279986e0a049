"""Commands that need no service: `galloping analyse`, `clearance`, `resolve`, `example` and `ellipse`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import json
import os
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from app.cli.console import BAD_INPUT, FAILED, end, for_people, progress_bar, refuse, try_folder, try_output, write
from app.cli.inputs import read_request
from app.cli.options import (
    AnalysisFile,
    AsJson,
    CsvDirectory,
    DefaultsFile,
    LineFile,
    OutputFile,
    PlacementFile,
    PlotsDirectory,
    ReportFile,
    StudyFile,
    UnitsName,
)
from app.cli.report import print_distances, print_report
from app.pages.measures import BY_NAME, Units
from app.reference.source_lines import EXAMPLE_NAMES
from app.reference.source_studies import STUDY_NAMES

if TYPE_CHECKING:
    from app.convert import PointResult


def analyse(  # noqa: PLR0913, PLR0917 - the options of a command are its arguments
    line: LineFile,
    analysis: AnalysisFile = None,
    study: StudyFile = None,
    placement: PlacementFile = None,
    defaults: DefaultsFile = None,
    output: OutputFile = None,
    csv: CsvDirectory = None,
    plots: PlotsDirectory = None,
    report: ReportFile = None,
    as_json: AsJson = False,
    units: UnitsName = "si",
) -> None:
    """Analyse a line in this process, without service or database.

    On a terminal the verdict and the tables behind it are printed, else the whole result as JSON.
    """
    try_output(output)
    try_output(report)
    try_folder(csv)
    try_folder(plots)
    document = read_request(line, analysis, study, placement, defaults)
    if report is not None and document.get("study"):
        end("a report is for a line, not for a study", BAD_INPUT)
    request, points = _points(document)
    result = result_document(request, points)
    if output is not None or not for_people(as_json):
        write(result, output)
    if for_people(as_json):
        print_report(result, BY_NAME[units])
    if csv is not None:
        _write_tables(result, csv)
    if plots is not None:
        from app.cli.pictures import Wanted, draw_all

        draw_all(result, {point.point: point.orbits for point in points}, Wanted(plots))
    if report is not None:
        _write_report(request, points[0], report, BY_NAME[units])


def clearance(
    line: LineFile,
    analysis: AnalysisFile = None,
    output: OutputFile = None,
    as_json: AsJson = False,
    units: UnitsName = "si",
) -> None:
    """Print how near the motions of a line come to the phases and wires that it lists, without service or database.

    On a terminal the smallest distance of each pair is printed, else every distance as JSON.
    """
    from app.schemas.faults import Fault

    try_output(output)
    document = read_request(line, analysis, None)
    said = document["line"]
    if not isinstance(said, dict) or not said.get("phases"):
        refuse([Fault("/line/phases", "missing", "must list the phases and wires to which distances are taken")])
    asked = document.get("analysis", {})
    if isinstance(asked, dict):  # samples have no distances
        document = {**document, "analysis": {"uncertainty": {"samples": 0}, **asked}}
    result = computed(document)
    if output is not None or not for_people(as_json):
        write({name: result[name] for name in ("verdict", "clearances", "warnings", "failures")}, output)
    if for_people(as_json):
        print_distances(result, BY_NAME[units])


def computed(document: Any) -> Any:
    """Return the result document of a request, computed in this process; end the command if it is wrong or fails."""
    return result_document(*_points(document))


def _points(document: Any) -> tuple[dict[str, Any], list["PointResult"]]:
    """Return the request with all defaults, and its points."""
    from app.runtime.processes import ONE_BLAS_THREAD

    os.environ.update(ONE_BLAS_THREAD)  # before convert loads numpy, because BLAS reads it once
    from app import convert
    from app.schemas.faults import BadInput

    try:
        request = convert.read(convert.explicit_request(document))
    except BadInput as error:
        refuse(error.faults)
    complete = request.kept()
    points: list[PointResult] = []
    try:
        with progress_bar() as show:
            for item in convert.run(complete):
                if isinstance(item, convert.Advance):
                    show(item.fraction, item.step)
                else:
                    points.append(item)
    except (ArithmeticError, ValueError) as error:
        end(f"the computation failed: {error}", FAILED)
    return complete, points


def _write_tables(result: Mapping[str, Any], directory: Path) -> None:
    from app import convert
    from app.export import formats

    try:
        directory.mkdir(parents=True, exist_ok=True)
        for name in convert.TABLES:
            if rows := result[name]:
                text = "".join(formats.csv_text(list(rows[0]), rows))
                (directory / f"{name}.csv").write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        typer.echo(f"{directory} cannot be written: {error.strerror or error}", err=True)


def _write_report(request: Mapping[str, Any], point: "PointResult", path: Path, units: Units) -> None:
    from app.pages import reports

    material = reports.computed_material(request, point, datetime.now(UTC))
    try:
        if path.suffix.lower() in {".html", ".htm"}:
            path.write_text(reports.report_html_alone(material, units), encoding="utf-8")
        else:
            path.write_bytes(reports.report_pdf(material, units))
    except (OSError, reports.NotPrintable) as error:
        typer.echo(f"{path} cannot be written: {error}", err=True)


def resolve(line: LineFile, defaults: DefaultsFile = None, output: OutputFile = None) -> None:
    """Print the explicit line of one as an engineer knows it, and where each of its values came from."""
    from app import convert
    from app.schemas.faults import BadInput

    document = read_request(line, None, None, defaults=defaults)
    try:
        write(convert.resolve_document(document["line"]), output)
    except BadInput as error:
        refuse(error.faults)


def example(
    name: Annotated[str, typer.Argument(metavar="|".join(EXAMPLE_NAMES), help="One of the source's lines.")],
    study: Annotated[
        str | None, typer.Option(metavar="|".join(STUDY_NAMES), help="Print a request with this study of the line.")
    ] = None,
) -> None:
    """Print one of the source's lines, or a request for one of the source's studies of that line, ready to run."""
    from app.reference import source_lines, source_studies

    for kind, wanted, known in (("example", name, EXAMPLE_NAMES), ("study", study, STUDY_NAMES)):
        if wanted is not None and wanted not in known:
            end(f"there is no {kind} {wanted!r}; choose one of {', '.join(known)}", BAD_INPUT)
    write(source_lines.example(name) if study is None else source_studies.study_request(study, name), None)


def ellipse(
    method: Annotated[Literal["davison", "toye", "cigre", "aeso"], typer.Option(help="Method that gives the ellipse.")],
    sag_m: Annotated[float, typer.Option(help="Iced sag at mid-span [m].")],
    span_m: Annotated[float | None, typer.Option(help="Span length [m], for toye.")] = None,
    diameter_m: Annotated[
        float | None, typer.Option(help="Diameter of a sub-conductor [m], for cigre and aeso.")
    ] = None,
    subconductors: Annotated[int, typer.Option(help="Number of sub-conductors, for cigre and aeso.")] = 1,
) -> None:
    """Print the galloping ellipse of design practice at mid-loop; nulls if the method predicts no galloping."""
    from app import convert
    from app.schemas.faults import BadInput

    try:
        write(convert.ellipse(method, sag_m, span_m, diameter_m, subconductors), None)
    except BadInput as error:
        refuse(error.faults)


def result_document(request: Mapping[str, Any], points: Sequence["PointResult"]) -> Any:
    """Return the result document of a request and its points, as the command prints it."""
    from dataclasses import asdict

    from app import convert
    from app.export import formats

    tables: dict[str, list[dict[str, object]]] = {
        name: [{**point.axes, **row} for point in points for row in point.tables[name]] for name in convert.TABLES
    }
    return json.loads("".join(formats.result_text(request, [asdict(point) for point in points], tables)))
