"""What the tests of faults have measured, kept in a file for `python -m tests.faults.report`."""

import json
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("latest.json")


def note(name: str, found: dict[str, Any]) -> None:
    """Keep the figures of a test under its name, in the place of those of an earlier run."""
    FILE.write_text(json.dumps({**read(), name: found}, indent=1) + "\n")


def read() -> dict[str, Any]:
    """Return all figures by the names of their tests."""
    found: dict[str, Any] = json.loads(FILE.read_text()) if FILE.exists() else {}
    return found
