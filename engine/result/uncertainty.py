"""What the samples of the assumed values say: how likely, how far, and which assumption decides."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.result.columns import Column

Distribution = Literal["uniform", "log_uniform", "choice"]


def _onset(share: str, example: float) -> Column:
    return Column(
        f"Onset that {share} of the samples do not pass; null where that one has none up to critical_wind_limit",
        example,
        unit="m/s",
    )


def _size(direction: str, share: str, example: float, unit: str = "m") -> Column:
    return Column(
        f"Largest {direction} amplitude that {share} of the samples do not pass, 0 at rest; null where that one "
        "gallops and how far is not known",
        example,
        unit=unit,
    )


def _end(quantity: str, index: str, end: str, example: float) -> Column:
    return Column(f"{end} end of the 95 % interval of the {index} index on the {quantity}", example, unit="1")


def _explained(quantity: str, example: float) -> Column:
    return Column(
        f"Share of the {quantity}'s variance that the expansion behind the indices predicts at samples left out of it; "
        "below one half the indices are null",
        example,
        unit="1",
    )


@dataclass(frozen=True, slots=True)
class UncertaintyRow:
    """How the samples of the assumed values behave at one wind speed, or at any of those asked for.

    Each sample is in exactly one of the columns gallops to impossible. All are analysed with the hybrid model.
    """

    wind_speed_m_per_s: Annotated[
        float | None, Column("Wind speed; null for the row about all wind speeds asked for", 10.0, unit="m/s")
    ]
    probability: Annotated[
        float | None,
        Column("Share of the samples that gallop among those that gallop or rest; null where none does", 0.7, unit="1"),
    ]
    probability_lowest: Annotated[
        float,
        Column("Lower end of its 95 % interval (Wilson), as if no undecided sample galloped", 0.58, unit="1"),
    ]
    probability_highest: Annotated[
        float, Column("Upper end of its 95 % interval (Wilson), as if every undecided sample galloped", 0.8, unit="1")
    ]
    probability_change: Annotated[
        float | None, Column("Change of the probability from the first half of the samples to all", 0.016, unit="1")
    ]
    onset_p05_m_per_s: Annotated[float | None, _onset("5 %", 1.3)]
    onset_p50_m_per_s: Annotated[float | None, _onset("50 %", 4.6)]
    onset_p95_m_per_s: Annotated[float | None, _onset("95 %", 12.7)]
    onset_p50_change_m_per_s: Annotated[
        float | None, Column("Change of the median onset from the first half of the samples to all", -0.12, unit="m/s")
    ]
    vertical_p05_m: Annotated[float | None, _size("vertical", "5 %", 0.0)]
    vertical_p50_m: Annotated[float | None, _size("vertical", "50 %", 0.81)]
    vertical_p95_m: Annotated[float | None, _size("vertical", "95 %", 1.6)]
    horizontal_p05_m: Annotated[float | None, _size("horizontal", "5 %", 0.0)]
    horizontal_p50_m: Annotated[float | None, _size("horizontal", "50 %", 0.11)]
    horizontal_p95_m: Annotated[float | None, _size("horizontal", "95 %", 0.42)]
    torsional_p05_rad: Annotated[float | None, _size("torsional", "5 %", 0.0, "rad")]
    torsional_p50_rad: Annotated[float | None, _size("torsional", "50 %", 0.03, "rad")]
    torsional_p95_rad: Annotated[float | None, _size("torsional", "95 %", 0.2, "rad")]
    vertical_p50_change_m: Annotated[
        float | None,
        Column("Change of the median vertical amplitude from the first half of the samples to all", 0.02, unit="m"),
    ]
    gallops: Annotated[int, Column("Samples that gallop", 45, unit="1")]
    size_unknown: Annotated[
        int,
        Column(
            "Samples that gallop too, but how far is not known, as where nothing bounds the motion; in quantiles they "
            "are larger than any other",
            0,
            unit="1",
        ),
    ]
    rests: Annotated[int, Column("Samples that stay at rest", 19, unit="1")]
    unknown: Annotated[int, Column("Samples of which it is not known whether they gallop", 0, unit="1")]
    statically_unstable: Annotated[
        int, Column("Samples whose static state does not stand even without wind", 0, unit="1")
    ]
    impossible: Annotated[
        int, Column("Samples that break a rule, such as a tension above the rated strength", 0, unit="1")
    ]
    beyond_data: Annotated[
        int,
        Column("Galloping samples of unknown size, or with a motion beyond coefficients or sag", 2, unit="1"),
    ]
    samples: Annotated[int, Column("Number of samples", 64, unit="1")]
    seed: Annotated[int, Column("Seed of the samples", 1, unit="1")]


@dataclass(frozen=True, slots=True)
class SensitivityRow:
    """What one assumed value means for the onset and for the largest vertical amplitude at the wind speeds asked for.

    Indices are shares of the variance over the samples: of the logarithm of the onset, which is critical_wind_limit
    where there is none, and of the amplitude, which is 0 at rest. First order: by this value alone; total: also
    together with others. They are null where the samples do not tell them, or where there is nothing to share.
    """

    path: Annotated[str, Column("Field of the assumed value", "damping.vertical_ratio")]
    distribution: Annotated[
        Distribution,
        Column("How values were drawn; log_uniform where the range spans a factor of two or more", "log_uniform"),
    ]
    lowest: Annotated[float | None, Column("Lowest value, in the unit of assumptions; null for a choice", 0.0005)]
    highest: Annotated[float | None, Column("Highest value; null for a choice", 0.005)]
    onset_first_order: Annotated[float | None, Column("First-order Sobol index on the onset", 0.84, unit="1")]
    onset_first_order_lowest: Annotated[float | None, _end("onset", "first-order", "Lower", 0.72)]
    onset_first_order_highest: Annotated[float | None, _end("onset", "first-order", "Upper", 0.93)]
    onset_total: Annotated[float | None, Column("Total Sobol index on the onset", 0.88, unit="1")]
    onset_total_lowest: Annotated[float | None, _end("onset", "total", "Lower", 0.76)]
    onset_total_highest: Annotated[float | None, _end("onset", "total", "Upper", 0.96)]
    onset_at_lowest_m_per_s: Annotated[
        float | None,
        Column("Onset at the lowest value with all others as assumed (of a choice: the lowest onset)", 1.1, unit="m/s"),
    ]
    onset_at_highest_m_per_s: Annotated[
        float | None, Column("Onset at the highest value (of a choice: the highest onset)", 11.2, unit="m/s")
    ]
    amplitude_first_order: Annotated[float | None, Column("First-order Sobol index on the amplitude", 0.81, unit="1")]
    amplitude_first_order_lowest: Annotated[float | None, _end("amplitude", "first-order", "Lower", 0.7)]
    amplitude_first_order_highest: Annotated[float | None, _end("amplitude", "first-order", "Upper", 0.9)]
    amplitude_total: Annotated[float | None, Column("Total Sobol index on the amplitude", 0.86, unit="1")]
    amplitude_total_lowest: Annotated[float | None, _end("amplitude", "total", "Lower", 0.75)]
    amplitude_total_highest: Annotated[float | None, _end("amplitude", "total", "Upper", 0.95)]
    vertical_at_lowest_m: Annotated[
        float | None,
        Column("Vertical amplitude at the lowest value (of a choice: the smallest); null if not known", 1.4, unit="m"),
    ]
    vertical_at_highest_m: Annotated[
        float | None,
        Column("Vertical amplitude at the highest value (of a choice: the largest); null if not known", 0.4, unit="m"),
    ]
    onset_explained: Annotated[float | None, _explained("onset", 0.93)]
    amplitude_explained: Annotated[float | None, _explained("amplitude", 0.9)]
    onset_samples: Annotated[int, Column("Samples behind the indices on the onset", 64, unit="1")]
    amplitude_samples: Annotated[int, Column("Samples behind the indices on the amplitude", 64, unit="1")]
