"""The configuration file of the command line: defaults of options, in TOML."""

import os
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from app.cli.console import BAD_INPUT, end

_KNOWN: Mapping[str, type] = {
    "url": str,
    "key_file": str,
    "data_dir": str,
    "host": str,
    "port": int,
    "output_dir": str,
    "theme": str,
    "units": str,
    "quiet": bool,
}
_PATHS = ("key_file", "data_dir", "output_dir")
_CHOICES = {"theme": ("light", "dark"), "units": ("si", "feet")}
_KINDS = {str: "text", int: "a whole number", bool: "true or false"}


def usual_file() -> Path:
    """Return the file that is read where none is named, in the folder of the platform for configurations."""
    return Path(typer.get_app_dir("galloping")) / "config.toml"


def configured(named: Path | None) -> dict[str, Any]:
    """Return defaults of options by the names of their parameters; end the command with a line for every fault.

    Parameters
    ----------
    named : Path, optional
        The file; the usual one if None, which need not exist. Paths in it start from its folder.
    """
    file = named or usual_file()
    if named is None and not file.is_file():
        return {}
    try:
        document = tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        end(f"{file} cannot be read: {error.strerror or error}", BAD_INPUT)
    except ValueError as error:
        end(f"{file}: {error}", BAD_INPUT)
    if faults := list(_faults(document)):
        end("\n".join(f"{file}: {fault}" for fault in faults), BAD_INPUT)
    paths = {name: str(file.parent / Path(document[name]).expanduser()) for name in _PATHS if name in document}
    if "GALLOPING_KEY" in os.environ:  # the environment goes before the file
        paths, document = ({k: v for k, v in part.items() if k != "key_file"} for part in (paths, document))
    return document | paths


def _faults(document: Mapping[str, object]) -> Iterator[str]:
    for name, value in document.items():
        if name not in _KNOWN:
            yield f"{name}: is not known; may be {', '.join(_KNOWN)}"
        elif type(value) is not _KNOWN[name]:
            yield f"{name}: must be {_KINDS[_KNOWN[name]]}, got {value!r}"
        elif value not in _CHOICES.get(name, (value,)):
            yield f"{name}: must be {' or '.join(_CHOICES[name])}, got {value!r}"
