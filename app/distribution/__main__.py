"""The command `galloping`, which says what to install where a part of the distribution was left out."""

import sys
from typing import NoReturn

_OURS = frozenset({"app", "engine", "galloping", "migrations", "worker"})


def main() -> None:
    """Run the command line."""
    try:
        from app.cli import main as run  # noqa: PLC0415 - typer may be absent

        run()
    except ModuleNotFoundError as error:
        _end(error)


def _end(error: ModuleNotFoundError) -> NoReturn:
    name = (error.name or "").partition(".")[0]
    if not name or name in _OURS:
        raise error
    sys.exit(f"this command needs {name}, which is not installed: pip install 'galloping[all]'")


if __name__ == "__main__":
    main()
