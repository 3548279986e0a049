"""What a study finds where the hybrid model's cycles are followed over its field."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.outcome import Stability
from engine.result.at_rest import LoopsColumn
from engine.result.columns import Column
from engine.result.motions import BifurcationType

_BranchColumn = Annotated[int, Column("Family over the field, for each number of loops and wind speed from 0", 1)]


@dataclass(frozen=True, slots=True)
class FollowedCycleRow:
    """A cycle of the hybrid model on a branch over the field of a study, at one of its values."""

    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 5.32, unit="m/s")]
    branch: _BranchColumn
    stability: Annotated[Stability, Column("Whether it lasts", "stable")]
    frequency_hz: Annotated[float, Column("Frequency", 0.4819, unit="Hz")]
    observed_at_m: Annotated[
        float, Column("Horizontal position of the amplitudes, from the left support", 62.94, unit="m")
    ]
    vertical_m: Annotated[float, Column("Vertical amplitude", 0.1128, unit="m")]
    horizontal_m: Annotated[float, Column("Horizontal amplitude", 0.0089, unit="m")]
    torsional_rad: Annotated[float, Column("Torsional amplitude", 0.1213, unit="rad")]
    found_by: Annotated[Literal["point", "field_branch"], Column("Whether the point alone has it too", "point")]


@dataclass(frozen=True, slots=True)
class FollowedBifurcationRow:
    """A bifurcation on a branch over the field of a study; value and uncertainty are in the field's unit."""

    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 5.32, unit="m/s")]
    branch: _BranchColumn
    type: Annotated[BifurcationType, Column("Kind of change", "fold")]
    value: Annotated[float, Column("Value of the field, in its own unit", 0.0099985)]
    frequency_hz: Annotated[float, Column("Frequency there", 0.4819, unit="Hz")]
    second_frequency_hz: Annotated[float | None, Column("Second frequency that begins there", None, unit="Hz")]
    uncertainty: Annotated[float, Column("How well the value is known, in its own unit", 6e-7)]
