"""Remedies against galloping: the line as it is, and with each remedy that was tried."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.result.columns import Column
from engine.result.verdict import Gallops, Trust

Change = Literal["better", "worse", "no_improvement", "undecided"]
RowKind = Literal[
    "none",
    "detuning_pendulum",
    "spacer",
    "torsional_damper",
    "interphase_spacer",
    "airflow_spoiler",
    "moved",
    "tension",
]


def _size(direction: str, share: str, example: float) -> Column:
    return Column(
        f"Largest {direction} amplitude that {share} of the samples do not pass, peak to peak; null where that one "
        "gallops and how far is not known, and without samples",
        example,
        unit="m",
    )


def _share(what: str, example: float) -> Column:
    return Column(f"{what}; null without samples", example, unit="1")


@dataclass(frozen=True, slots=True)
class RemedyRow:
    """The line as it is, or with one remedy.

    Motions are the stable ones at the wind speeds asked for. Everything that is not known is null. Samples compare the
    line with the remedy and the line as it is in the same values of everything assumed.
    """

    remedy: Annotated[
        int | None, Column("Number of the remedy in the request, from 0; null for the line as it is", 0, unit="1")
    ]
    kind: Annotated[RowKind, Column("Kind of remedy; none for the line as it is", "detuning_pendulum")]
    what: Annotated[
        str, Column("What is done, in words", "4 detuning pendulums of 20 kg, arm 0.4 m, at 60, 120, 180 and 240 m")
    ]
    places: Annotated[
        str | None,
        Column("Places of its devices from left to right [m], a spoiler's middle; null without any", "60 120 180 240"),
    ]
    change: Annotated[
        Change | None,
        Column(
            "better: onset, largest motion and clearance are each as good as without or better, and one is better by "
            "more than one per cent; worse: one is worse and none better; no_improvement: neither, or better in one "
            "and worse in another; undecided: a figure of either line is not known; null for the line as it is",
            "better",
        ),
    ]
    rank: Annotated[
        int | None,
        Column("Place among the remedies that are better, from 1, by the largest motion; null for others", 1, unit="1"),
    ]
    gallops: Annotated[Gallops, Column("Whether the span gallops; undecided where that is not known", "yes")]
    onset_m_per_s: Annotated[float | None, Column("Lowest onset of an oscillation; null without one", 2.1, unit="m/s")]
    vertical_peak_to_peak_m: Annotated[
        float | None, Column("Largest vertical motion, peak to peak; 0 at rest", 1.4, unit="m")
    ]
    horizontal_peak_to_peak_m: Annotated[
        float | None, Column("Largest horizontal motion, peak to peak; 0 at rest", 0.3, unit="m")
    ]
    motion_peak_to_peak_m: Annotated[
        float | None, Column("Largest sqrt(V^2 + W^2) of a motion, peak to peak; 0 at rest", 1.45, unit="m")
    ]
    clearance_m: Annotated[
        float | None, Column("Smallest distance to another phase; null where none is given", 5.1, unit="m")
    ]
    clearance_margin_m: Annotated[
        float | None, Column("Smallest distance less the required one; null where none is required", 3.6, unit="m")
    ]
    static_tension_n: Annotated[
        float | None, Column("Horizontal tension of a sub-conductor at rest, under ice", 38450.0, unit="N")
    ]
    tension_range_n: Annotated[
        float | None,
        Column(
            "Largest less smallest tension at the higher support in the worst motion; null if stretching is neglected",
            2100.0,
            unit="N",
        ),
    ]
    onset_change_m_per_s: Annotated[
        float | None, Column("Onset less that of the line as it is; null where one has none", 0.3, unit="m/s")
    ]
    motion_change: Annotated[
        float | None,
        Column("Largest motion over that of the line as it is, less 1; null where that is at rest", -0.35, unit="1"),
    ]
    trust: Annotated[Trust, Column("How far to trust the figures, as in the verdict", "plausible")]
    arrangements: Annotated[
        int | None, Column("Arrangements that the search computed; null where places were given", 48, unit="1")
    ]
    probability_gallops: Annotated[float | None, _share("Share of the samples that gallop among those decided", 0.7)]
    onset_p50_m_per_s: Annotated[
        float | None, Column("Median onset of the samples; null without one, and without samples", 2.3, unit="m/s")
    ]
    vertical_p50_m: Annotated[float | None, _size("vertical", "half", 1.1)]
    vertical_p95_m: Annotated[float | None, _size("vertical", "95 %", 2.4)]
    improves: Annotated[
        float | None, _share("Share of the samples in which the remedy is better; undecided ones do not count", 0.85)
    ]
    improves_lowest: Annotated[float | None, _share("Lower end of its 95 % interval (Wilson)", 0.75)]
    improves_highest: Annotated[float | None, _share("Upper end of its 95 % interval (Wilson)", 0.92)]
    worsens: Annotated[float | None, _share("Share of the samples in which the remedy is worse", 0.05)]
    undecided_samples: Annotated[float | None, _share("Share of the samples of which that is not known", 0.0)]
    samples: Annotated[int, Column("Samples of the assumed values that can exist", 64, unit="1")]
    sentence: Annotated[
        str,
        Column(
            "What the remedy does, in words",
            "Better: the onset rises from 1.8 to 2.1 m/s, the largest motion falls from 2.2 to 1.4 m peak to peak.",
        ),
    ]
