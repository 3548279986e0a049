"""The engine stands on numpy, scipy and a few modules of the standard library that touch nothing outside."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import engine

ROOT = Path(engine.__file__).parent
ALLOWED = frozenset(
    {
        "bisect",
        "cmath",
        "collections",
        "dataclasses",
        "engine",
        "enum",
        "functools",
        "itertools",
        "math",
        "numpy",
        "scipy",
        "typing",
    }
)


def imported(tree: ast.AST) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or "engine"


@pytest.mark.parametrize("path", sorted(ROOT.rglob("*.py")), ids=lambda path: str(path.relative_to(ROOT)))
def test_a_module_imports_only_what_the_engine_stands_on(path: Path) -> None:
    names = {name.partition(".")[0] for name in imported(ast.parse(path.read_text(encoding="utf-8")))}
    assert names <= ALLOWED


def test_an_import_is_seen_wherever_it_stands() -> None:
    text = "import os.path\ndef f():\n    from requests.api import get\n    import a, b.c\nfrom . import d\n"
    assert set(imported(ast.parse(text))) == {"os.path", "requests.api", "a", "b.c", "engine"}


def test_nothing_is_imported_by_name_at_run_time() -> None:
    for path in ROOT.rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        assert "__import__" not in text
        assert "importlib" not in text
