"""The command line: `galloping` and its commands, grouped in modules by subject."""

import typer

from app.cli import catalogue, climate, keys, lines, operate, pictures, remedies, service

app = typer.Typer(
    help="Tells whether an iced transmission-line span gallops, from which wind speed, and how far.",
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    add_completion=False,
    pretty_exceptions_enable=False,
)
for command in (
    lines.analyse,
    remedies.remedies,
    service.serve,
    service.api,
    service.worker,
    service.migrate,
    service.submit,
    lines.example,
    lines.ellipse,
    lines.resolve,
    lines.clearance,
    pictures.plot,
    climate.climate,
    catalogue.conductors,
    catalogue.ice_shapes,
    operate.status,
    operate.prune,
    operate.audit,
):
    app.command()(command)
app.add_typer(keys.commands, name="keys")


def main() -> None:
    """Run the command line."""
    app()
