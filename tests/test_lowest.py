"""The lower bounds of dependencies are those with which `make lowest` runs the tests."""

import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import NormalizedName, canonicalize_name
from packaging.version import Version

ROOT = Path(__file__).parents[1]
NOT_INSTALLED = {"audit", "bench", "dev"}  # extras for work on the software


def bounds() -> dict[NormalizedName, Version]:
    """Return the lowest version of every dependency that pyproject.toml allows."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = [named for extra, named in project["optional-dependencies"].items() if extra not in NOT_INSTALLED]
    needed = [Requirement(text) for named in (project["dependencies"], *extras) for text in named]
    return {
        canonicalize_name(one.name): Version(bound.version)
        for one in needed
        for bound in one.specifier
        if bound.operator == ">="
    }


def test_the_lowest_versions_are_tested() -> None:
    pins = (line.split("==") for line in (ROOT / "constraints-lowest.txt").read_text().splitlines())
    tested = {canonicalize_name(name): Version(version) for name, version in pins}
    assert len(bounds()) > 30
    assert {name: tested[name] for name in bounds()} == bounds()
