"""The lines of a batch, the ones to look at first first, and those of them that a reader wants to see."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Feature = Mapping[str, Any]
ANSWERS = ("yes", "no", "undecided")
_ENDED = ("successful", "failed", "rejected")


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which lines a reader wants to see: an answer of the verdict, and a part of a name, reference or asset."""

    gallops: str = ""
    name: str = ""

    def fits(self, line: Mapping[str, Any]) -> bool:
        """Tell whether a line is wanted."""
        texts = (line["name"], line["reference"], line["asset_id"], line["number"])
        named = any(self.name.casefold() in str(text).casefold() for text in texts if text is not None)
        return (not self.gallops or line["gallops"] == self.gallops) and (not self.name or named)


@dataclass(frozen=True, slots=True)
class Overview:
    """The wanted lines as features in their order, and how many lines have each answer, of all lines."""

    features: Sequence[Feature]
    answers: Mapping[str, int]

    @property
    def lines(self) -> Sequence[Mapping[str, Any]]:
        """Return the summaries of the wanted lines."""
        return [feature["properties"] for feature in self.features]

    def values(self, column: str) -> list[float]:
        """Return the known numbers of a column."""
        return [line[column] for line in self.lines if line[column] is not None]


def overview(features: Iterable[Feature], wanted: Wanted) -> Overview:
    """Return the lines of a batch: unknown motions and failures before known motions, the largest of these first."""
    found = list(features)
    answers = Counter(feature["properties"]["gallops"] for feature in found)
    shown = [feature for feature in found if wanted.fits(feature["properties"])]
    ordered = sorted(shown, key=lambda feature: _order(feature["properties"]))
    return Overview(ordered, {answer: answers[answer] for answer in ANSWERS})


def _order(line: Mapping[str, Any]) -> tuple[int, float, int]:
    """Unknown is never the end of a list: first what is unknown, then what failed, then by size; last what waits."""
    amplitude = line["vertical_peak_to_peak_m"]
    if line["unknown_motions"] or line["gallops"] == "undecided":
        rank = 0
    elif line["status"] in {"failed", "rejected"}:
        rank = 1
    else:
        rank = 2 if line["status"] in _ENDED else 3
    return rank, -(amplitude or 0.0), line["number"]
