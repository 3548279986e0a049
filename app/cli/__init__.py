"""The command line: `galloping` and its commands, grouped in modules by subject."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import typer

from app.cli import catalogue, climate, coefficients, lines, pictures, remedies
from app.cli.common import Quiet, Version, with_common_options
from app.cli.operation import audit, keys, operate, service
from app.cli.remote import batch, jobs, submit

Command = Callable[..., Any]

_COMMANDS: Mapping[str, Sequence[Command]] = {
    "Work out a line here": (
        lines.analyse,
        remedies.remedies,
        lines.clearance,
        lines.resolve,
        pictures.plot,
        climate.climate,
        coefficients.fit,
        lines.ellipse,
    ),
    "Look up": (lines.example, catalogue.conductors, catalogue.ice_shapes, catalogue.fields),
    "Send lines to a service": (submit.submit, batch.batch),
    "Run a service": (
        service.serve,
        service.api,
        service.worker,
        service.migrate,
        operate.status,
        operate.prune,
    ),
}

app = typer.Typer(
    help="Tells whether an iced transmission-line span gallops, from which wind speed, and how far.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)


@app.callback()
def _galloping(
    version: Version = False,
    quiet: Quiet = False,
) -> None:
    pass


for panel, commands in _COMMANDS.items():
    for command in commands:
        app.command(rich_help_panel=panel)(with_common_options(command))
app.add_typer(jobs.commands, name="jobs", rich_help_panel="Send lines to a service")
app.add_typer(audit.commands, name="audit", rich_help_panel="Run a service")
app.add_typer(keys.commands, name="keys", rich_help_panel="Run a service")


def main() -> None:
    """Run the command line."""
    app(prog_name="galloping")
