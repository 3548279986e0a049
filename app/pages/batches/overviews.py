"""The lines of a batch, the ones to look at first first, and those of them that a reader wants to see."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any
from urllib.parse import urlencode

from app.reference.text_forms import composed, folded

Feature = Mapping[str, Any]
ANSWERS = ("yes", "no", "undecided")
_MOST_TAGS = 100  # that are offered; any other can be typed
_ENDED = ("successful", "failed", "rejected")


@dataclass(frozen=True, slots=True)
class Wanted:
    """Which lines a reader wants to see: an answer of the verdict, a part of a name, reference or asset, and a tag.

    tag: key:value, or a key alone.
    """

    gallops: str = ""
    name: str = ""
    tag: str = ""

    @property
    def query(self) -> str:
        """Return the wishes as the query of an address, empty without any."""
        return urlencode({name: value for name, value in asdict(self).items() if value})

    def fits(self, feature: Feature) -> bool:
        """Tell whether a line is wanted."""
        line = feature["properties"]
        texts = (line["name"], line["reference"], line["asset_id"], line["number"])
        named = any(folded(self.name) in folded(str(text)) for text in texts if text is not None)
        tagged = any(composed(self.tag) in {key, f"{key}:{value}"} for key, value in feature["tags"].items())
        return (
            (not self.gallops or line["gallops"] == self.gallops)
            and (not self.name or named)
            and (not self.tag or tagged)
        )


@dataclass(frozen=True, slots=True)
class Overview:
    """The wanted lines as features in their order; of all lines, how many have each answer and each tag.

    tags: key:value, the commonest first.
    """

    features: Sequence[Feature]
    answers: Mapping[str, int]
    tags: Mapping[str, int]

    @property
    def numbers(self) -> set[int]:
        """Return the numbers of the wanted lines."""
        return {line["number"] for line in self.lines}

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
    tags = Counter(f"{key}:{value}" for feature in found for key, value in feature["tags"].items())
    shown = [feature for feature in found if wanted.fits(feature)]
    ordered = sorted(shown, key=lambda feature: _order(feature["properties"]))
    return Overview(ordered, {answer: answers[answer] for answer in ANSWERS}, dict(tags.most_common(_MOST_TAGS)))


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
