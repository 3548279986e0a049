"""The picture of the packages, docs/images/rooms.svg: `python -m benchmarks.rooms` draws it from the tree itself.

Boxes are the packages and modules in the layers of the import contracts (pyproject.toml), the upper ones first; a box
may import from boxes below it only. Sentences are the first paragraphs of their docstrings.
"""

import ast
import re
import textwrap
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape
from pathlib import Path

ROOT = Path(__file__).parents[1]
PICTURE = ROOT / "docs" / "images" / "rooms.svg"
COLUMNS = {"app": "the service's layers", "engine": "the engine's layers"}  # and the contracts that order them
TITLES = ("The service. A box imports only from boxes below it.", "The engine. It imports nothing of the service.")
ABOVE = {"app": [["migrations", "worker"]], "engine": []}  # layers on top of those of the contract
BORDER = ("worker", "app.convert")  # the only ones that import the engine

WIDTH = 640.0  # of a column [px], as all lengths below
GAP = 10.0
LINE = 16.0
MARGIN = 24.0
TOP = MARGIN + 3.0 * LINE
CORRIDOR = 70.0  # between the columns
CHARACTER = 7.0  # mean width of the text


@dataclass(frozen=True, slots=True)
class Room:
    """A package or module: its dotted name, the first paragraph of its docstring, and the modules in it."""

    name: str
    head: str
    modules: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Box:
    """A room on the page: its left upper corner and width, and its text in lines [px]."""

    room: Room
    x: float
    y: float
    width: float

    @property
    def texts(self) -> list[tuple[str, str]]:
        """Lines of text with the class of their style."""
        letters = int((self.width - 2.0 * GAP) / CHARACTER)
        inside = ", ".join(self.room.modules)
        return [
            ("name", self.room.name),
            *(("head", line) for line in textwrap.wrap(self.room.head, letters)),
            *(("inside", line) for line in textwrap.wrap(inside, letters)),
        ]

    @property
    def height(self) -> float:
        """Height of the frame."""
        return LINE * len(self.texts) + GAP


def layers(root: Path, contract: str) -> list[list[str]]:
    """Return the layers of an import contract by its name, the upper ones first, each a list of dotted names."""
    contracts = tomllib.loads((root / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (found,) = (one["layers"] for one in contracts if one["name"] == contract)
    return [[name.strip() for name in re.split(r"[|:]", layer)] for layer in found]


def room(root: Path, name: str) -> Room:
    """Read a package or module by its dotted name.

    Raises
    ------
    FileNotFoundError
        If there is none of this name.
    """
    folder = root.joinpath(*name.split("."))
    path = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
    paragraphs = (ast.get_docstring(ast.parse(path.read_text())) or "").split("\n\n")
    return Room(name, " ".join(paragraphs[0].replace("`", "").split()), tuple(_inside(folder)))


def boxes(root: Path) -> list[Box]:
    """Place all rooms: a column for each contract, a row for each layer."""
    return [box for i, name in enumerate(COLUMNS) for box in _column(root, name, MARGIN + i * (WIDTH + CORRIDOR))]


def picture(root: Path) -> str:
    """Return the whole picture as SVG."""
    placed = boxes(root)
    width = 2.0 * (WIDTH + MARGIN) + CORRIDOR
    height = max(box.y + box.height for box in placed) + MARGIN
    named = {box.room.name: box for box in placed}
    parts = [part for box in placed for part in _drawn(box)]
    for source in BORDER:
        parts += _arrow(named[source], MARGIN + WIDTH + CORRIDOR - GAP)
    return "\n".join([*_opening(width, height), *parts, "</svg>"]) + "\n"


def _inside(folder: Path) -> Iterator[str]:
    """Yield the names of a package's modules and, with a slash, of its packages."""
    if folder.is_dir():
        for path in sorted(folder.iterdir()):
            if path.suffix == ".py" and not path.stem.startswith("__"):
                yield path.stem
            elif (path / "__init__.py").is_file():
                yield f"{path.name}/"


def _column(root: Path, top: str, x: float) -> Iterator[Box]:
    y = TOP
    for names in [*ABOVE[top], *layers(root, COLUMNS[top])]:
        width = (WIDTH - GAP * (len(names) - 1)) / len(names)
        row = [Box(room(root, name), x + i * (width + GAP), y, width) for i, name in enumerate(names)]
        yield from row
        y += max(box.height for box in row) + GAP


def _opening(width: float, height: float) -> Iterator[str]:
    yield f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}">'
    yield "<title>Packages of the service and of the engine, with what belongs into each</title>"
    yield (
        "<style>text{font:13px sans-serif;fill:#222}.title{font-size:15px;font-weight:bold}"
        ".name{font-family:monospace;font-weight:bold}.inside{fill:#666;font-size:12px}"
        "rect{fill:#fff;stroke:#8aa0b8}.column{fill:#eef3f9;stroke:none}path{stroke:#b04a2f;stroke-width:2;fill:none}.tip{fill:#b04a2f}</style>"
    )
    yield f'<rect x="0" y="0" width="{width:g}" height="{height:g}" style="fill:#fff;stroke:none"/>'
    for i, title in enumerate(TITLES):
        x = MARGIN + i * (WIDTH + CORRIDOR)
        size = f'width="{WIDTH + 2.0 * GAP:g}" height="{height - TOP:g}"'
        yield f'<rect class="column" x="{x - GAP:g}" y="{TOP - GAP:g}" {size} rx="8"/>'
        yield f'<text class="title" x="{x:g}" y="{MARGIN + LINE:g}">{title}</text>'


def _drawn(box: Box) -> Iterator[str]:
    yield f'<rect x="{box.x:g}" y="{box.y:g}" width="{box.width:g}" height="{box.height:g}" rx="4"/>'
    for i, (style, text) in enumerate(box.texts):
        x, y = box.x + GAP, box.y + LINE * (i + 1)
        yield f'<text class="{style}" x="{x:g}" y="{y:g}">{escape(text)}</text>'


def _arrow(source: Box, end: float) -> list[str]:
    """Draw an arrow from the right side of a box to the other column."""
    begin, y = source.x + source.width, source.y + source.height / 2.0
    tip = f"{end:g},{y:g} {end - 9.0:g},{y - 5.0:g} {end - 9.0:g},{y + 5.0:g}"
    return [f'<path d="M{begin:g} {y:g}H{end - 8.0:g}"/>', f'<polygon class="tip" points="{tip}"/>']


def main() -> None:
    """Write the picture."""
    PICTURE.write_text(picture(ROOT))


if __name__ == "__main__":
    main()
