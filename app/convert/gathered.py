"""Faults collected while a line is built part by part, with neutral parts in the place of wrong ones."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TypeVar

from engine.outcome import Fault, InvalidSpec

Made = TypeVar("Made")
Source = TypeVar("Source")


@dataclass(frozen=True, slots=True)
class Gathered:
    """The faults found so far, with paths from the root of the line or the analysis, and the paths of neutral parts."""

    faults: list[Fault] = field(default_factory=list)
    neutral: list[str] = field(default_factory=list)

    def make(self, path: str, source: Source | None, maker: Callable[[Source], Made], neutral: Made) -> Made:
        """Return what `maker` builds from a source, or the neutral part if there is no source or it is wrong."""
        return self.settle(path, None if source is None else self.attempt(f"{path}.", lambda: maker(source)), neutral)

    def settle(self, path: str, made: Made | None, neutral: Made) -> Made:
        """Return what was built, or the neutral part, whose faults are ignored."""
        if made is None:
            self.neutral.append(path)
            return neutral
        return made

    def attempt(self, prefix: str, make: Callable[[], Made]) -> Made | None:
        """Return what is built, or collect its faults and return None."""
        try:
            return make()
        except InvalidSpec as error:
            found = [replace(fault, field=_rooted(prefix, fault.field)) for fault in error.faults]
            self.faults.extend(fault for fault in found if not self._is_neutral(fault.field))
            return None

    def _is_neutral(self, path: str) -> bool:
        return any(f"{path}.".startswith(f"{place}.") for place in self.neutral)


def _rooted(prefix: str, path: str) -> str:
    """Prepend a prefix to a path unless the engine's path begins at the root already."""
    root = prefix.split(".", maxsplit=1)[0]
    return path if not prefix or path.split(".", maxsplit=1)[0] == root else prefix + path
