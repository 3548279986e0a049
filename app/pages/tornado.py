"""What decides: for each assumption how far onset and amplitude move between its lowest and its highest value."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.pages.findings import Row
from app.pages.measures import Units

_MOST = 10
WIDTH = 100.0


@dataclass(frozen=True, slots=True)
class Bar:
    """A bar from the result at the lowest value to that at the highest, with places in percent of the width."""

    path: str
    low: str
    high: str
    share: float | None
    onset_share: float | None
    onset: tuple[str, str]
    start: float
    length: float
    falls: bool


def bars(rows: Sequence[Row], units: Units, unit_of: Mapping[str, str]) -> tuple[str, str, list[Bar]] | None:
    """Return the ends of the axis and the bars of the amplitude, the largest total Sobol index first.

    None where there are no samples, or no assumption changes the amplitude. `unit_of` has the SI units of the assumed
    values by their paths.
    """
    ends = [(row["vertical_at_lowest_m"], row["vertical_at_highest_m"]) for row in rows]
    known = [value for pair in ends for value in pair if value is not None]
    if not known or max(known) == min(known):
        return None
    first, reach = min(known), max(known) - min(known)
    ranked = sorted(rows, key=lambda row: -(row["amplitude_total"] or 0.0))
    found = [
        Bar(
            path=row["path"],
            low=units.number(row["lowest"], unit_of.get(row["path"])),
            high=units.shown(row["highest"], unit_of.get(row["path"])),
            share=row["amplitude_total"],
            onset_share=row["onset_total"],
            onset=(
                units.number(row["onset_at_lowest_m_per_s"], "m/s"),
                units.shown(row["onset_at_highest_m_per_s"], "m/s"),
            ),
            start=WIDTH * (min(low, high) - first) / reach,
            length=WIDTH * abs(high - low) / reach,
            falls=high < low,
        )
        for row in ranked
        if (low := row["vertical_at_lowest_m"]) is not None and (high := row["vertical_at_highest_m"]) is not None
    ]
    return units.shown(first, "m"), units.shown(first + reach, "m"), found[:_MOST]
