"""Styles and scripts of the pages, the service's own and vendored ones, at addresses that change with their content."""

import hashlib
import os
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

import app

ADDRESS = "/pages/assets"
_FOLDERS = {"own": "pages/static", "htmx": "vendor/htmx", "uplot": "vendor/uplot"}
_FOR_EVER = "public, max-age=31536000, immutable"


class _Lasting(StaticFiles):
    """Files whose address holds a mark of their content, so that a browser may keep them."""

    def file_response(
        self, full_path: Any, stat_result: os.stat_result, scope: Scope, status_code: int = 200
    ) -> Response:
        """Return the answer with a file; without its mark in the query it is checked at each use."""
        answer = super().file_response(full_path, stat_result, scope, status_code)
        answer.headers["Cache-Control"] = _FOR_EVER if scope["query_string"] else "no-cache"
        return answer


def folders() -> dict[str, StaticFiles]:
    """Return the applications that serve the folders, by their addresses."""
    return {f"{ADDRESS}/{name}": _Lasting(packages=[(app.__name__, folder)]) for name, folder in _FOLDERS.items()}


@cache
def address(name: str) -> str:
    """Return the address of a file such as `own/site.css`, without the prefix of a proxy.

    Raises
    ------
    OSError
        If there is no such file.
    """
    return f"{ADDRESS}/{name}?v={hashlib.sha256(_path(name).read_bytes()).hexdigest()[:12]}"


def script_bytes() -> int:
    """Return the size of all scripts that pages may load [bytes]."""
    folders_of_files = (Path(str(resources.files(app))) / folder for folder in _FOLDERS.values())
    return sum(path.stat().st_size for folder in folders_of_files for path in folder.glob("*.js"))


def _path(name: str) -> Path:
    folder, _, file = name.partition("/")
    return Path(str(resources.files(app))) / _FOLDERS[folder] / file
