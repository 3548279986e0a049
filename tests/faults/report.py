"""Print what `make test-faults` measured; with `--write`, put it on docs/reliability.md, too."""

import argparse
import re
from pathlib import Path
from typing import Any

from tests.faults import figures

PAGE = Path(__file__).parents[2] / "docs" / "reliability.md"
_SECTION = "<!-- figures: {} -->\n{}<!-- end of figures -->"


def main() -> None:
    """Print the sentences of all tests that have run; put them between the markers of the page if asked to."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="write docs/reliability.md anew")
    page, write = PAGE.read_text(), parser.parse_args().write
    for name, found in figures.read().items():
        print(f"{name}\n{table(found)}\n")
        page = with_section(page, name, table(found))
    if write:
        PAGE.write_text(page)


def table(found: dict[str, Any]) -> str:
    """Return figures as a table in Markdown."""
    rows = [
        "| measured | figure |",
        "| --- | --- |",
        *(f"| {name} | {_text(value)} |" for name, value in found.items()),
    ]
    return "\n".join(rows)


def _text(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{count} {name}" for name, count in value.items())
    return value if isinstance(value, str) else f"{value:,}"


def with_section(page: str, name: str, text: str) -> str:
    """Return a page with a text between the markers of a name.

    Raises
    ------
    ValueError
        If the page has no such markers.
    """
    pattern = re.escape(_SECTION.format(name, "@")).replace("@", ".*?")
    changed, count = re.subn(pattern, lambda _: _SECTION.format(name, f"{text}\n"), page, flags=re.DOTALL)
    if count != 1:
        raise ValueError(f"{PAGE.name} has {count} places for the figures of {name}, not one")
    return changed


if __name__ == "__main__":
    main()
