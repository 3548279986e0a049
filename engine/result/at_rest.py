"""Results about the resting span: static state, Den Hartog's criterion, frequencies, critical wind speeds."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.outcome import Outcome
from engine.result.columns import Column
from engine.spec import (
    AerodynamicLoad,
    AerodynamicModel,
    CrossSection,
    LongitudinalInertia,
    Model,
    Physics,
    StaticTwist,
    Stretching,
)

Direction = Literal["vertical", "horizontal", "torsional", "longitudinal"]
Neighbours = Literal["static_springs", "given_springs", "dead_ends", "moving"]
ModelColumn = Annotated[Model, Column("Model that the row comes from", "hybrid")]
LoopsColumn = Annotated[int, Column("Loops per span; in a section the number of the mode", 1, unit="1")]
OutcomeColumn = Annotated[Outcome, Column("How the computation ended", "converged")]
SpanColumn = Annotated[
    int | None, Column("Span of a section, from 1, that moves most; null for a single span and at rest", 3, unit="1")
]
SpanSharesColumn = Annotated[
    str | None,
    Column("Shares of all spans of a section in the kinetic energy, from left to right", "0.04 0.26 0.40 0.26 0.04"),
]
PhaseColumn = Annotated[
    str | None,
    Column('Phase that moves most, "this" for the line itself; null where no spacers tie phases, and at rest', None),
]
PhaseSharesColumn = Annotated[
    str | None, Column("Shares of the tied phases in the kinetic energy, the line first", None)
]


@dataclass(frozen=True, slots=True)
class StaticState:
    """Static state of the span; in a study one row per point, after the values of the axes.

    Theory section 2. The stiffness is the smaller one of both ends.
    """

    horizontal_tension_n: Annotated[float, Column("Horizontal tension of one iced sub-conductor", 30000.0, unit="N")]
    catenary_parameter_m: Annotated[float, Column("Tension over weight per length", 1285.46, unit="m")]
    sag_m: Annotated[float, Column("Sag at mid-span", 1.5412, unit="m")]
    longitudinal_stiffness_n_per_m: Annotated[
        float | None, Column("Longitudinal stiffness of the supports; null at dead ends", 128460.7, unit="N/m")
    ]
    twist_rad: Annotated[
        float | None, Column("Largest static twist of the sections; null where it is neglected", -0.75, unit="rad")
    ]


@dataclass(frozen=True, slots=True)
class DenHartog:
    """Den Hartog's criterion; in a study one row per point, after the values of the axes.

    The coefficient a_y1 is the smallest on the span.
    """

    coefficient: Annotated[float, Column("dC_L/dalpha + C_D of one sub-conductor", -0.1667, unit="1/rad")]
    unstable: Annotated[bool, Column("Whether the coefficient is negative; null if unknown", True)]


@dataclass(frozen=True, slots=True)
class PhysicsRow:
    """The physics of the analysis: the set of options, and the options in force; a request may set each separately."""

    physics: Annotated[Physics, Column("Set of options; the request may have set some of them differently", "full")]
    aerodynamic_model: Annotated[AerodynamicModel, Column("Velocities that change the wind", "relative_wind")]
    aerodynamic_load: Annotated[AerodynamicLoad, Column("Whether the load is expanded in the motion", "expanded")]
    longitudinal_inertia: Annotated[
        LongitudinalInertia, Column("Longitudinal inertia of the hybrid model", "condensed")
    ]
    stretching: Annotated[Stretching, Column("Stretching of the conductors by large motion", "included")]
    static_twist: Annotated[
        StaticTwist, Column("Whether eccentric weight twists the line at rest, or only where that is large", "solved")
    ]
    section: Annotated[
        CrossSection | None,
        Column("Whether the sub-conductors move along the span alike or each by itself; null for a single one", "free"),
    ]
    neighbours: Annotated[
        Neighbours,
        Column(
            "What holds the ends along the line: static_springs (A10) take the adjacent spans as equal ones at rest "
            "that only give way statically; moving: the spans of a section, with swinging strings",
            "static_springs",
        ),
    ]


@dataclass(frozen=True, slots=True)
class FrequencyRow:
    """Natural frequencies without wind, labelled by dominant direction.

    They are null unless converged.
    """

    model: ModelColumn
    loops: LoopsColumn
    vertical_hz: Annotated[float | None, Column("Dominantly vertical", 0.4816, unit="Hz")]
    horizontal_hz: Annotated[float | None, Column("Dominantly horizontal", 0.4460, unit="Hz")]
    torsional_hz: Annotated[float | None, Column("Dominantly torsional", 0.6343, unit="Hz")]
    outcome: OutcomeColumn = Outcome.CONVERGED


@dataclass(frozen=True, slots=True)
class SectionModeRow:
    """A natural mode of a section without wind, numbered by frequency within its direction.

    Theory section 16. Of the hybrid model these are modes of each direction by itself.
    """

    model: ModelColumn
    direction: Annotated[Direction, Column("Direction of the largest kinetic energy", "vertical")]
    mode: Annotated[int, Column("Number of the mode within its direction, from 1, by frequency", 1, unit="1")]
    frequency_hz: Annotated[
        float | None, Column("Frequency; null where the static state is unstable", 0.18698, unit="Hz")
    ]
    span: Annotated[int, Column("Span that moves most, from 1; the first one of several alike", 3, unit="1")]
    span_shares: Annotated[
        str,
        Column("Shares of all spans in the kinetic energy, from left to right", "0.0385 0.2616 0.3998 0.2617 0.0384"),
    ]


@dataclass(frozen=True, slots=True)
class InternalResonanceRow:
    """How close two natural frequencies without wind are to a ratio of small integers."""

    model: ModelColumn
    loops: LoopsColumn
    directions: Annotated[
        str, Column("Directions whose frequencies are compared, in this order", "horizontal:vertical")
    ]
    frequency_ratio: Annotated[float, Column("The first frequency over the second", 0.9261, unit="1")]
    nearest_ratio: Annotated[str, Column("Nearest ratio of integers up to 3", "1:1")]
    detuning: Annotated[float, Column("Frequency ratio divided by the nearest ratio, minus 1", -0.0739, unit="1")]


@dataclass(frozen=True, slots=True)
class CriticalWindSpeedRow:
    """A wind speed at which the resting span loses or regains stability.

    Theory section 6: eigenvalues of the static state cross the imaginary axis.
    """

    model: ModelColumn
    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed of the crossing", 2.403, unit="m/s")]
    crossing: Annotated[Literal["onset", "restabilization"], Column("Whether stability is lost or regained", "onset")]
    type: Annotated[
        Literal["oscillation", "divergence"], Column("Whether the growing motion oscillates", "oscillation")
    ]
    direction: Annotated[Direction, Column("Dominant direction of the growing motion", "vertical")]
    frequency_hz: Annotated[float, Column("Frequency of the growing motion; 0 for a divergence", 0.4816, unit="Hz")]
    unstable_pairs_after: Annotated[int, Column("Unstable pairs of eigenvalues above this wind speed", 1, unit="1")]
    span: SpanColumn = None
    span_shares: SpanSharesColumn = None
    phase: PhaseColumn = None
    phase_shares: PhaseSharesColumn = None


@dataclass(frozen=True, slots=True)
class StaticEquilibriumRow:
    """A stable angle at which the sections rest under the mean moment of the wind, counted from still air.

    Theory section 14. The first one at each wind speed is that which a rising wind finds.
    """

    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 10.0, unit="m/s")]
    equilibrium: Annotated[int, Column("0: the twist that a rising wind leads to; from 1: further stable ones", 0)]
    twist_rad: Annotated[
        float | None, Column("Twist at mid-span; null where no equilibrium was found", 0.0137, unit="rad")
    ]
    largest_twist_rad: Annotated[float | None, Column("Twist of largest size along the span", 0.0137, unit="rad")]
    outcome: OutcomeColumn
