"""Builds the distribution, whose only import name is `galloping`; docs/decisions/0070-one-import-name.md says why.

The tree has four packages at its top, and editable installs keep them there. Elsewhere `app`, `engine`, `migrations`
and `worker` would be names that other software has, too. So a wheel holds them inside `galloping`, and their imports of
each other are rewritten while it is built.
"""

import re
import shutil
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py

OUTER = "galloping"
INNER = ("app", "engine", "migrations", "worker")

_NAMES = "|".join(INNER)
_FROM = re.compile(rf"^(\s*from )((?:{_NAMES})(?:\.\w+)* import )", re.MULTILINE)
_WHOLE = re.compile(rf"^(\s*)(import (?:{_NAMES}))$", re.MULTILINE)
_LEFT = re.compile(rf"^\s*import (?:{_NAMES})\b.*$", re.MULTILINE)


def rewritten(source: str) -> str:
    """Return a module's source whose imports of the inner packages name them inside the outer one.

    Raises
    ------
    ValueError
        If an import statement has a form whose meaning would change, such as `import app.cli`.
    """
    found = _FROM.sub(rf"\1{OUTER}.\2", source)
    found = _WHOLE.sub(rf"\1from {OUTER} \2", found)
    if left := _LEFT.search(found):
        raise ValueError(f"write `from package import module` in place of `{left[0].strip()}`")
    return found


def enclose(built: Path) -> None:
    """Move the inner packages of a built tree into the outer one, files that are there already included."""
    for name in INNER:
        for path in sorted((built / name).rglob("*")):
            if path.is_file():
                place = built / OUTER / path.relative_to(built)
                place.parent.mkdir(parents=True, exist_ok=True)
                path.replace(place)
        shutil.rmtree(built / name, ignore_errors=True)


class BuildPython(build_py):
    """Builds the modules, and encloses them unless the tree itself is installed."""

    def run(self) -> None:
        """Build."""
        if self.editable_mode:
            super().run()
            return
        built = Path(self.build_lib)
        shutil.rmtree(built, ignore_errors=True)  # modules of an earlier build may be gone from the tree
        super().run()
        enclose(built)
        for path in (built / OUTER).rglob("*.py"):
            path.write_text(rewritten(path.read_text(encoding="utf-8")), encoding="utf-8")


class BuildKernels(build_ext):
    """Builds the kernels, and encloses them as `BuildPython` does."""

    def run(self) -> None:
        """Build."""
        super().run()
        if not self.inplace:
            enclose(Path(self.build_lib))


setup(
    packages=[OUTER, *find_packages(include=[f"{name}*" for name in INNER], exclude=["app.distribution"])],
    package_dir={OUTER: "app/distribution"},
    cmdclass={"build_py": BuildPython, "build_ext": BuildKernels},
)
