"""What the command line does whatever the command: the options --version, --config and --quiet."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer

from app.cli.configuration import configured
from app.cli.console import placed, quietly
from app.cli.options import OutputFolder

_PANEL = "For every command"


def _print_version(wanted: bool) -> None:
    if not wanted:
        return
    from app.convert import ENGINE_VERSION
    from app.runtime.version import SERVICE_VERSION

    typer.echo(f"galloping {SERVICE_VERSION}, engine {ENGINE_VERSION}")
    raise typer.Exit


def _be_quiet(context: typer.Context, wanted: bool) -> bool:
    if wanted:
        context.with_resource(quietly())
    return wanted


def _configure(context: typer.Context, file: Path | None) -> Path | None:
    if not context.resilient_parsing:  # completion goes on with a wrong file
        context.default_map = configured(file)
    return file


Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the versions and exit.")
]
Quiet = Annotated[
    bool,
    typer.Option(
        "--quiet",
        "-q",
        envvar="GALLOPING_QUIET",
        callback=_be_quiet,
        rich_help_panel=_PANEL,
        help="Print results and faults only: no progress, no notes.",
    ),
]
_Config = Annotated[
    Path | None,
    typer.Option(
        "--config",
        metavar="FILE",
        envvar="GALLOPING_CONFIG",
        callback=_configure,
        is_eager=True,
        rich_help_panel=_PANEL,
        help="TOML file with defaults of options.",
    ),
]


def with_common_options(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command that takes --config and --quiet, too; what these say is done before it begins.

    One that writes files of results takes --output-dir as well.
    """
    signature = inspect.signature(command)
    added: list[tuple[str, Any, Any]] = [("quiet", False, Quiet), ("config", None, _Config)]
    if any(_is_placed(parameter) for parameter in signature.parameters.values()):
        added.append(("output_dir", None, OutputFolder))  # after the configuration file, which may name it

    @functools.wraps(command)
    def run(**given: Any) -> None:
        command(**{name: value for name, value in given.items() if name in signature.parameters})

    common = [
        inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation)
        for name, default, annotation in added
    ]
    run.__signature__ = signature.replace(parameters=[*signature.parameters.values(), *common])  # type: ignore[attr-defined]
    return run


def _is_placed(parameter: inspect.Parameter) -> bool:
    options = getattr(parameter.annotation, "__metadata__", ())
    return any(getattr(option, "callback", None) is placed for option in options)
