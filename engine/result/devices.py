"""Effects of devices, and the devices that a search has placed."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.result.at_rest import ModelColumn
from engine.result.columns import Column
from engine.spec import Objective


@dataclass(frozen=True, slots=True)
class DeviceEffectRow:
    """Lowest onset and largest stable amplitude, without and with devices."""

    model: ModelColumn
    loops: Annotated[int, Column("Loops per span", 2, unit="1")]
    wind_speed_m_per_s: Annotated[
        float | None, Column("Wind speed of the amplitudes; null if none was asked for", 4.0, unit="m/s")
    ]
    critical_wind_speed_without_m_per_s: Annotated[
        float | None, Column("Lowest onset without devices; null if there is none", 2.25, unit="m/s")
    ]
    critical_wind_speed_with_m_per_s: Annotated[
        float | None, Column("Lowest onset with devices; null if there is none", 2.59, unit="m/s")
    ]
    amplitude_without_m: Annotated[
        float | None, Column("Largest sqrt(V^2 + W^2) without devices; 0 at rest, null if unknown", 0.373, unit="m")
    ]
    amplitude_with_m: Annotated[
        float | None, Column("Largest sqrt(V^2 + W^2) with devices; 0 at rest, null if unknown", 0.096, unit="m")
    ]


@dataclass(frozen=True, slots=True)
class PlacedDeviceRow:
    """A device that a search has placed.

    If the objective is the critical wind speed and there is none up to the limit, the objective value is the limit.
    """

    device: Annotated[int, Column("Index of the device on the line, from 0", 0, unit="1")]
    type: Annotated[Literal["detuning_pendulum", "airflow_spoiler"], Column("Kind of device", "detuning_pendulum")]
    position_m: Annotated[float | None, Column("Position of a pendulum", 68.5, unit="m")]
    mass_kg: Annotated[float | None, Column("Mass of a pendulum", 19.9, unit="kg")]
    arm_m: Annotated[float | None, Column("Arm of a pendulum", 0.46, unit="m")]
    from_m: Annotated[float | None, Column("Start of a spoiler", None, unit="m")]
    to_m: Annotated[float | None, Column("End of a spoiler", None, unit="m")]
    objective: Annotated[Objective, Column("Objective of the search", "highest_critical_wind_speed")]
    objective_value: Annotated[
        float | None, Column("Objective value reached, in m/s or m; null if no candidate has one", 2.547)
    ]
    evaluations: Annotated[int, Column("Number of different candidates computed", 80, unit="1")]
    generations: Annotated[int, Column("Number of generations of the search", 4, unit="1")]
