"""The command that turns an hourly weather record into the climate of a line: `galloping climate`."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from pathlib import Path
from typing import Annotated

import typer

from app.cli.console import BAD_INPUT, end, refuse, write
from app.cli.options import OutputFile


def climate(
    weather: Annotated[Path, typer.Argument(metavar="WEATHER.csv", help="Hourly weather, with a column `time`.")],
    line_azimuth_deg: Annotated[float, typer.Option(help="Direction of the line, clockwise from north [deg].")],
    least_thickness_m: Annotated[
        float | None, typer.Option(help="Thickness from which the line counts as iced [m]; 0.001 if absent.")
    ] = None,
    output: OutputFile = None,
) -> None:
    """Print the climate of a line from hourly weather: its iced hours, and how they were found."""
    from app.convert.weather import climate_of_weather
    from app.schemas.faults import BadInput

    try:
        write(climate_of_weather(weather.read_bytes(), line_azimuth_deg, least_thickness_m), output)
    except OSError as error:
        end(f"{weather} cannot be read: {error.strerror or error}", BAD_INPUT)
    except BadInput as error:
        refuse(error.faults)
