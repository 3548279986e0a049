"""The verdict: what a line's result means for the one who has to decide."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.result.columns import Column

Gallops = Literal["yes", "no", "undecided"]
Trust = Literal["checked", "plausible", "beyond_data"]


@dataclass(frozen=True, slots=True)
class VerdictRow:
    """Whether the span gallops at wind speeds up to the highest one asked for, how far, and how well that is known.

    The worst motion is the stable one of the largest vertical amplitude, of any model and number of loops. Everything
    that is not known is null.
    """

    gallops: Annotated[Gallops, Column("Whether the span gallops; undecided where that is not known", "yes")]
    onset_m_per_s: Annotated[
        float | None,
        Column(
            "Lowest wind speed at which the span at rest loses stability to an oscillation, also above those asked for",
            2.346,
            unit="m/s",
        ),
    ]
    worst_wind_m_per_s: Annotated[float | None, Column("Wind speed of the worst motion", 10.0, unit="m/s")]
    worst_loops: Annotated[int | None, Column("Number of loops of the worst motion", 1, unit="1")]
    vertical_peak_to_peak_m: Annotated[
        float | None, Column("Vertical motion of the worst one, peak to peak", 1.128, unit="m")
    ]
    horizontal_peak_to_peak_m: Annotated[
        float | None, Column("Horizontal motion of the worst one, peak to peak", 0.167, unit="m")
    ]
    tension_range_n: Annotated[
        float | None,
        Column(
            "Largest less smallest tension at the higher support in the worst motion; null if stretching is neglected",
            3478.0,
            unit="N",
        ),
    ]
    largest_share_of_rated_strength: Annotated[
        float | None,
        Column(
            "Largest tension at the higher support in the worst motion over the rated strength; null where it is not "
            "known",
            0.23,
            unit="1",
        ),
    ]
    clearance_m: Annotated[
        float | None, Column("Smallest distance to another phase; null where none is given", None, unit="m")
    ]
    clearance_margin_m: Annotated[
        float | None,
        Column("Smallest distance less the required one, of all phases; null where it is not known", None, unit="m"),
    ]
    clearance_ok: Annotated[
        bool | None, Column("Whether that distance is the required one or more; null where it is not known", None)
    ]
    ellipse_peak_to_peak_m: Annotated[
        float | None,
        Column("Major axis of the design ellipse of CIGRE TB 322; null where it gives none", 4.2, unit="m"),
    ]
    probability_gallops: Annotated[
        float | None, Column("Share of the samples that gallop; null without samples", None, unit="1")
    ]
    trust: Annotated[
        Trust,
        Column(
            "checked: every stable cycle was held against direct integration (check: direct) and agrees within one per "
            "cent; beyond_data: a motion, or the state at rest, leaves what the input can vouch for; plausible: "
            "otherwise",
            "plausible",
        ),
    ]
    sentence: Annotated[
        str,
        Column("The verdict in words", "Gallops from 2.3 m/s; at 10 m/s in one loop, 1.13 m peak to peak vertically."),
    ]
    what_decides: Annotated[str | None, Column("The assumed value that decides most; null without samples", None)]
