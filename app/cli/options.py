"""Options and arguments that several commands share."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from app.cli.console import placed, remember_folder

OutputFolder = Annotated[
    Path | None,
    typer.Option(
        "--output-dir",
        metavar="DIR",
        callback=remember_folder,
        is_eager=True,  # before the options whose paths start from it
        help="Folder from which relative paths of files for results start.",
    ),
]

LineFile = Annotated[
    Path,
    typer.Argument(
        metavar="LINE.json",
        help="A line, or {line, analysis, study, placement}; - for standard input. Also one line as GeoJSON (.geojson) "
        "or CIM (.xml, .rdf).",
    ),
]
DefaultsFile = Annotated[
    Path | None, typer.Option("--defaults", metavar="DEFAULTS.json", help="Fields that the line leaves open.")
]
AnalysisFile = Annotated[
    Path | None, typer.Option("--analysis", metavar="ANALYSIS.json", help="The analysis; defaults if absent.")
]
StudyFile = Annotated[Path | None, typer.Option("--study", metavar="STUDY.json", help="Fields of the line to vary.")]
PlacementFile = Annotated[Path | None, typer.Option("--placement", metavar="PLACEMENT.json", help="Devices to place.")]
OutputFile = Annotated[
    Path | None,
    typer.Option(
        "--output", metavar="RESULT.json", callback=placed, help="File for the result; standard output if absent."
    ),
]
CsvDirectory = Annotated[
    Path | None,
    typer.Option("--csv", metavar="DIR", callback=placed, help="Write every table with rows there as a CSV file."),
]
PlotsDirectory = Annotated[
    Path | None,
    typer.Option(
        "--plots", metavar="DIR", callback=placed, help="Draw every picture that the result has rows for there."
    ),
]
ReportFile = Annotated[
    Path | None,
    typer.Option(
        "--report", metavar="REPORT.pdf", callback=placed, help="Write a report of the result, as PDF or .html."
    ),
]
UnitsName = Annotated[
    Literal["si", "feet"], typer.Option("--units", help="Units of what people read; JSON and CSV are in SI.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON also on a terminal.")]
DataDirectory = Annotated[
    Path | None, typer.Option("--data-dir", envvar="GALLOPING_DATA_DIR", help="Directory for all files of the service.")
]
