"""What the command line does whatever the command: the option --version."""
# ruff: noqa: PLC0415 - a command imports what it needs, so that --help and example answer at once

from typing import Annotated

import typer


def _print_version(wanted: bool) -> None:
    if not wanted:
        return
    from app.convert import ENGINE_VERSION
    from app.runtime.version import SERVICE_VERSION

    typer.echo(f"galloping {SERVICE_VERSION}, engine {ENGINE_VERSION}")
    raise typer.Exit


Version = Annotated[
    bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the versions and exit.")
]
