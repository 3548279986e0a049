"""Every text that pages show, from one file, `app/pages/strings.toml`; another language is another such file."""

import tomllib
from functools import cache
from importlib import resources
from types import SimpleNamespace
from typing import Any

FILE = "strings.toml"


@cache
def words() -> Any:
    """Return the texts by their sections, read as attributes: `words().start.title`.

    A name that is not there raises AttributeError, in a template as well as here.
    """
    return _named(tomllib.loads((resources.files(__package__) / FILE).read_text(encoding="utf-8")))


def word_for(section: Any, name: str) -> str:
    """Return the text for a value that results hold, such as `quasi_periodic`; the value itself if it has none."""
    return str(getattr(section, name, name.replace("_", " ")))


def _named(value: Any) -> Any:
    if isinstance(value, dict):
        return SimpleNamespace(**{name: _named(inner) for name, inner in value.items()})
    return value
