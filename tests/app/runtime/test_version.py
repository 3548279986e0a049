import tomllib
from pathlib import Path

from app.runtime.version import SERVICE_VERSION

ROOT = Path(__file__).parents[3]


def test_it_is_that_of_the_distribution() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    assert SERVICE_VERSION in {declared, "unknown"}
