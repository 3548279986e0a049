"""Results about phases: the modes of tied phases, and the clearances between phases."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.outcome import Stability
from engine.result.at_rest import Direction, ModelColumn
from engine.result.columns import Column

ClearanceMethod = Literal["computed", "davison", "toye", "cigre", "aeso"]
Together = Literal["in time", "any phase angle", "at rest"]


@dataclass(frozen=True, slots=True)
class PhaseModeRow:
    """A natural mode of phases that interphase spacers tie, without wind.

    The phases are in the order of the line, "this", and then of its `phases`, as far as spacers tie them.
    """

    model: ModelColumn
    direction: Annotated[Direction, Column("Direction of the largest kinetic energy", "vertical")]
    mode: Annotated[int, Column("Number of the mode within its direction, from 1, by frequency", 1, unit="1")]
    loops: Annotated[int, Column("Loops in the phase that moves most", 1, unit="1")]
    frequency_hz: Annotated[
        float | None, Column("Frequency; null where the static state is unstable", 0.4815, unit="Hz")
    ]
    phase: Annotated[str, Column("Phase that moves most; the first one of several alike", "this")]
    phase_shares: Annotated[str, Column("Shares of the tied phases in the kinetic energy", "0.5000 0.5000")]
    phase_motion: Annotated[
        str,
        Column(
            "Motion of each tied phase where the largest one is, as a share of that: equal numbers move alike, "
            "opposite signs against each other",
            "1.000 1.000",
        ),
    ]


@dataclass(frozen=True, slots=True)
class PhaseClearanceRow:
    """The smallest distance of two phases in a motion, or under a galloping ellipse of design practice.

    Distances are those between the centres of sub-conductors.
    """

    phase: Annotated[str, Column('One phase; "this" is the line itself', "this")]
    other_phase: Annotated[str, Column("The other phase", "top")]
    method: Annotated[ClearanceMethod, Column("Computed motion, or the method of an ellipse", "computed")]
    together: Annotated[
        Together,
        Column(
            "How both phases move: in time, as they gallop together tied by spacers; any phase angle, both as the line "
            "does, at the worst instants of each; at rest, the other phase does not move",
            "in time",
        ),
    ]
    model: Annotated[str | None, Column("Model of a computed motion; null for an ellipse", "finite_element")]
    loops: Annotated[int, Column("Loops of the motion, or of the ellipse", 1, unit="1")]
    wind_speed_m_per_s: Annotated[float | None, Column("Wind speed; null for an ellipse", 4.0, unit="m/s")]
    branch: Annotated[int | None, Column("Family of cycles; null for an ellipse", 0)]
    stability: Annotated[Stability | None, Column("Stability of the motion; null for an ellipse", "stable")]
    position_m: Annotated[
        float | None,
        Column("Place of the smallest distance, from the left support; null for an ellipse", 62.94, unit="m"),
    ]
    distance_m: Annotated[
        float | None, Column("Smallest distance; negative if ellipses overlap; null without one", 6.4, unit="m")
    ]
    required_m: Annotated[float | None, Column("Required distance; null if none is given", 1.5, unit="m")]
    margin_m: Annotated[float | None, Column("Distance less the required one", 4.9, unit="m")]
    ok: Annotated[bool | None, Column("Whether the distance is the required one or more; null if not known", True)]
    overlap_m: Annotated[
        float | None, Column("By how much the envelopes overlap; 0 if they do not, null without them", 0.0, unit="m")
    ] = None
    ahead_span_length_m: Annotated[
        float | None, Column("Length of the span; null for phases that spacers tie", 125.88, unit="m")
    ] = None
    mid_span_sag_m: Annotated[
        float | None, Column("Sag of the one phase at mid-span, in its plane; null for tied phases", 1.54, unit="m")
    ] = None
    span_swing_angle_deg: Annotated[
        float | None,
        Column(
            "Angle by which the wind swings the one phase, positive downwind; null for tied phases", 0.0, unit="deg"
        ),
    ] = None
    major_axis_m: Annotated[
        float | None, Column("Major axis of the one phase's ellipse; null for a motion", None, unit="m")
    ] = None
    minor_axis_m: Annotated[float | None, Column("Minor axis of that ellipse", None, unit="m")] = None
    b_distance_m: Annotated[
        float | None, Column("Distance of that ellipse's lowest point below the resting wire", None, unit="m")
    ] = None
