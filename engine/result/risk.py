"""The risk: hours of galloping to expect in a year, in the climate of the line."""

from dataclasses import dataclass
from typing import Annotated

from engine.result.at_rest import ModelColumn
from engine.result.columns import Column


@dataclass(frozen=True, slots=True)
class RiskRow:
    """Hours of galloping a year, and the probability of a year with galloping, by model, loops and kind of ice.

    Galloping is a stable motion, or rest that an oscillation leaves. The intervals hold for every value within the
    ranges of the climate, and for every wind speed of which it is not known whether the line gallops; over samples of
    the line they hold 95 % of these, too.
    """

    model: ModelColumn
    loops: Annotated[int | None, Column("Loops per span; null for any of those asked for", 1, unit="1")]
    ice: Annotated[str | None, Column("Kind of ice of the climate; null for all kinds together", "glaze")]
    thickness_m: Annotated[float | None, Column("Thickness of that ice; null where not given", 0.012, unit="m")]
    hours_a_year: Annotated[float, Column("Expected hours of galloping a year", 6.4, unit="h")]
    hours_lowest: Annotated[float, Column("Lower end of their interval", 3.1, unit="h")]
    hours_highest: Annotated[float, Column("Upper end of their interval", 12.7, unit="h")]
    unknown_hours_a_year: Annotated[
        float,
        Column("Iced hours a year at wind speeds of which nothing is known; not in hours_a_year", 0.4, unit="h"),
    ]
    probability_a_year: Annotated[
        float | None,
        Column("Probability that the line gallops at least once a year; null without events of icing", 0.62, unit="1"),
    ]
    probability_lowest: Annotated[float | None, Column("Lower end of its interval", 0.31, unit="1")]
    probability_highest: Annotated[float | None, Column("Upper end of its interval", 0.93, unit="1")]
    violation_hours_a_year: Annotated[
        float | None,
        Column(
            "Expected hours a year with less than the required clearance, of the line as it is without samples; null "
            "where no clearance is required",
            None,
            unit="h",
        ),
    ]
    violation_hours_highest: Annotated[
        float | None, Column("Upper end of their interval, with wind speeds of which it is not known", None, unit="h")
    ]
    violation_probability_a_year: Annotated[
        float | None,
        Column("Probability of such an hour in a year; null where not known", None, unit="1"),
    ]
    samples: Annotated[int, Column("Samples of the line that this is the mean of; 1: the line as it is", 1, unit="1")]
