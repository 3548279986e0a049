"""The documents name files that exist, and their links lead somewhere."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
MADE = {"benchmarks/latest.json"}  # written by a run, not kept
NAMED = re.compile(r"(?<![\w/.])(?:app|benchmarks|docs|engine|migrations|tests|worker)/[\w/.-]*\w")
LINK = re.compile(r"\]\(([^)#\s]+)(?:#([^)\s]+))?\)|\]\(#([^)\s]+)\)")


def headings(page: Path) -> Iterator[str]:
    """Yield the anchors of a page's headings, as they are made from their words."""
    for title in re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE):
        yield re.sub(r"[^\w -]", "", title.lower()).replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_files_that_a_page_names_exist(page: Path) -> None:
    named = {Path(name) for name in NAMED.findall(page.read_text())} - {Path(name) for name in MADE}
    missing = [name for name in named if not (ROOT / name).exists() and not (ROOT / name).with_suffix(".py").exists()]
    assert missing == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_of_a_page_lead_to_files_and_headings(page: Path) -> None:
    for name, anchor, own in LINK.findall(page.read_text()):
        if "://" in name:
            continue
        target = page.parent / name if name else page
        assert target.exists(), name
        if anchor or own:
            assert (anchor or own) in headings(target), f"{name}#{anchor or own}"


def test_types_that_the_nomenclature_names_exist() -> None:
    sources = "\n".join(path.read_text() for top in ("engine", "app") for path in (ROOT / top).rglob("*.py"))
    named = re.findall(r"`([A-Z]\w+)`", (ROOT / "docs" / "nomenclature.md").read_text())
    assert [name for name in named if not re.search(rf"^class {name}\b", sources, re.MULTILINE)] == []
