"""Results of a study that follows the hybrid model's cycles over its field."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.outcome import Stability
from engine.result.at_rest import LoopsColumn
from engine.result.columns import Column
from engine.result.motions import BifurcationType

_BranchColumn = Annotated[
    int, Column("Family over the field, numbered from 0 for each number of loops and wind speed", 1)
]


@dataclass(frozen=True, slots=True)
class FollowedCycleRow:
    """A cycle of the hybrid model on a branch over the field of a study, at one value of the field."""

    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 5.32, unit="m/s")]
    branch: _BranchColumn
    stability: Annotated[Stability, Column("Stability of the cycle", "stable")]
    frequency_hz: Annotated[float, Column("Frequency", 0.4819, unit="Hz")]
    observed_at_m: Annotated[float, Column("Position of the amplitudes, from the left support", 62.94, unit="m")]
    vertical_m: Annotated[float, Column("Vertical amplitude", 0.1128, unit="m")]
    horizontal_m: Annotated[float, Column("Horizontal amplitude", 0.0089, unit="m")]
    torsional_rad: Annotated[float, Column("Torsional amplitude", 0.1213, unit="rad")]
    found_by: Annotated[
        Literal["point", "field_branch"],
        Column("point if the point's own analysis found it too, else field_branch", "point"),
    ]


@dataclass(frozen=True, slots=True)
class FollowedBifurcationRow:
    """A bifurcation on a branch over the field of a study; value and uncertainty are in the field's unit."""

    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 5.32, unit="m/s")]
    branch: _BranchColumn
    type: Annotated[BifurcationType, Column("Kind of bifurcation", "fold")]
    value: Annotated[float, Column("Value of the field, in the field's unit", 0.0099985)]
    frequency_hz: Annotated[float, Column("Frequency of the motion at the bifurcation", 0.4819, unit="Hz")]
    second_frequency_hz: Annotated[
        float | None, Column("Second frequency of the motion that begins there", None, unit="Hz")
    ]
    uncertainty: Annotated[float, Column("Uncertainty of the value, in the field's unit", 6e-7)]
