"""Results about motion: limit cycles, their bifurcations, and comparisons between models and loops."""

from dataclasses import dataclass
from typing import Annotated, Literal

from engine.outcome import Stability
from engine.result.at_rest import (
    LoopsColumn,
    ModelColumn,
    OutcomeColumn,
    PhaseColumn,
    PhaseSharesColumn,
    SpanColumn,
    SpanSharesColumn,
)
from engine.result.columns import Column

FoundBy = Literal[
    "hopf_branch", "explicit", "energy_balance", "direct_integration", "branch", "torus_point", "unstable_cycle"
]
BifurcationType = Literal["hopf", "fold", "torus", "period_doubling", "branch_point", "unresolved"]


@dataclass(frozen=True)  # without slots: a line has dozens of these rows, and orjson serializes them from `__dict__`
class LimitCycleRow:
    """A motion at one wind speed; amplitudes are half of peak-to-peak.

    The equilibrium, a cycle or a quasi-periodic motion, theory section 8. The shares divide the mean kinetic energy
    between the directions.
    """

    model: ModelColumn
    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 4.0, unit="m/s")]
    branch: Annotated[int | None, Column("Family of cycles; null for the equilibrium", 0)]
    kind: Annotated[Literal["equilibrium", "periodic", "quasi_periodic"], Column("Kind of motion", "periodic")]
    stability: Annotated[Stability, Column("Stability of the motion; unknown if it could not be decided", "stable")]
    frequency_hz: Annotated[float | None, Column("Frequency; null for the equilibrium", 0.4816, unit="Hz")]
    second_frequency_hz: Annotated[float | None, Column("Second frequency of a quasi-periodic motion", None, unit="Hz")]
    observed_at_m: Annotated[float, Column("Position of the amplitudes, from the left support", 62.94, unit="m")]
    vertical_m: Annotated[float | None, Column("Vertical amplitude", 0.1568, unit="m")]
    horizontal_m: Annotated[float | None, Column("Horizontal amplitude", 0.0099, unit="m")]
    torsional_rad: Annotated[float | None, Column("Torsional amplitude", 0.0020, unit="rad")]
    vertical_min_m: Annotated[
        float | None, Column("Smaller vertical amplitude of a quasi-periodic motion", None, unit="m")
    ]
    horizontal_min_m: Annotated[
        float | None, Column("Smaller horizontal amplitude of a quasi-periodic motion", None, unit="m")
    ]
    torsional_min_rad: Annotated[
        float | None, Column("Smaller torsional amplitude of a quasi-periodic motion", None, unit="rad")
    ]
    vertical_ratio: Annotated[float | None, Column("Vertical amplitude over the static sag", 0.1018, unit="1")]
    horizontal_ratio: Annotated[float | None, Column("Horizontal amplitude over the static sag", 0.0064, unit="1")]
    reduced_wind_speed: Annotated[float | None, Column("Wind speed divided by frequency and span", 0.066, unit="1")]
    vertical_share: Annotated[
        float | None, Column("Vertical share of the mean kinetic energy; null at rest", 0.9927, unit="1")
    ]
    horizontal_share: Annotated[
        float | None, Column("Horizontal share of the mean kinetic energy; null at rest", 0.0034, unit="1")
    ]
    torsional_share: Annotated[
        float | None, Column("Torsional share of the mean kinetic energy; null at rest", 0.0039, unit="1")
    ]
    largest_angle_of_attack_rad: Annotated[
        float | None,
        Column("Largest absolute angle of attack along the span and over time; null at rest", 0.1194, unit="rad"),
    ]
    largest_velocity_ratio: Annotated[
        float | None,
        Column("Largest velocity of a sub-conductor over that of the wind; null at rest", 0.1186, unit="1"),
    ]
    found_by: Annotated[
        FoundBy | None,
        Column(
            "Search that found it: Hopf branch, explicit formula, energy balance, direct integration, or a branch "
            "continued from one of those; for a quasi-periodic motion a torus point or an unstable cycle; null at rest",
            "hopf_branch",
        ),
    ]
    harmonics: Annotated[
        int | None,
        Column(
            "Harmonics of the balance; for a quasi-periodic motion those of its frequency; null at rest", 5, unit="1"
        ),
    ]
    residual: Annotated[
        float | None, Column("Largest residual of the equations over the largest elastic force", 2.1e-13, unit="1")
    ]
    truncation: Annotated[
        float | None, Column("Relative change of the amplitude with one more harmonic", 3.4e-8, unit="1")
    ]
    detuning_sensitivity: Annotated[
        float | None,
        Column(
            "Largest relative change of the amplitude if the horizontal frequency rises or falls by 0.1 %, or falls by "
            "as much as stretching raises it; null if the cycle does not survive one of these shifts",
            -0.0031,
            unit="1",
        ),
    ]
    direct_difference: Annotated[
        float | None,
        Column(
            "Relative change of the amplitude in 50 periods of direct integration; null unless check is direct",
            None,
            unit="1",
        ),
    ]
    outcome: OutcomeColumn
    span: SpanColumn = None
    span_shares: SpanSharesColumn = None
    phase: PhaseColumn = None
    vertical_middle_m: Annotated[
        float | None, Column("Middle of a quasi-periodic motion's range; null for others", None, unit="m")
    ] = None
    horizontal_middle_m: Annotated[float | None, Column("The same, horizontally", None, unit="m")] = None
    torsional_middle_rad: Annotated[float | None, Column("The same, in rotation", None, unit="rad")] = None
    phase_shares: PhaseSharesColumn = None


@dataclass(frozen=True, slots=True)
class BifurcationRow:
    """A wind speed at which the kind or the number of motions changes."""

    model: ModelColumn
    loops: LoopsColumn
    branch: Annotated[int, Column("Family of cycles", 0)]
    type: Annotated[
        BifurcationType,
        Column("Kind of bifurcation; unresolved: stability changes and its cause was not found", "torus"),
    ]
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 6.82, unit="m/s")]
    frequency_hz: Annotated[float, Column("Frequency of the motion at the bifurcation", 0.4816, unit="Hz")]
    second_frequency_hz: Annotated[
        float | None, Column("Second frequency of the motion that begins there", 0.0121, unit="Hz")
    ]
    uncertainty_m_per_s: Annotated[float, Column("Uncertainty of the wind speed", 0.01, unit="m/s")]


@dataclass(frozen=True)  # without slots, as above
class TensionRow:
    """The range of tension over a motion, static and dynamic part together, over all sub-conductors of free sections.

    Theory sections 12.1 and 12.2. No numbers where a conductor would go slack.
    """

    model: ModelColumn
    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 10.0, unit="m/s")]
    branch: Annotated[int, Column("Family of cycles", 0)]
    kind: Annotated[Literal["periodic", "quasi_periodic"], Column("Kind of motion", "periodic")]
    stability: Annotated[Stability, Column("Stability of the motion", "stable")]
    smallest_horizontal_n: Annotated[float | None, Column("Smallest horizontal component", 28583.0, unit="N")]
    largest_horizontal_n: Annotated[float | None, Column("Largest horizontal component", 32057.0, unit="N")]
    smallest_at_support_n: Annotated[float | None, Column("Smallest tension at the higher support", 28617.0, unit="N")]
    largest_at_support_n: Annotated[float | None, Column("Largest tension at the higher support", 32095.0, unit="N")]
    largest_share_of_rated_strength: Annotated[
        float | None,
        Column("Largest tension at the higher support over the rated strength, null without one", 0.23, unit="1"),
    ]
    outcome: OutcomeColumn
    span: Annotated[
        int | None, Column("Span of a section, from 1, whose tension it is; null for a single span", None, unit="1")
    ] = None
    phase: Annotated[
        str | None, Column('Tied phase whose tension it is, "this" for the line itself; null for a single span', None)
    ] = None


@dataclass(frozen=True, slots=True)
class AmplitudeCurveRow:
    """A computed point of a branch of limit cycles; amplitudes are half of peak-to-peak.

    The wind speeds are the steps of the continuation. A family that does not begin at a single Hopf point has several
    curves.
    """

    model: ModelColumn
    loops: LoopsColumn
    branch: Annotated[int, Column("Family of cycles", 0)]
    curve: Annotated[int, Column("Index of the curve within the family, from 0", 0)]
    point: Annotated[int, Column("Index along the curve, from 0", 7)]
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 2.649, unit="m/s")]
    frequency_hz: Annotated[float, Column("Frequency", 0.4816, unit="Hz")]
    observed_at_m: Annotated[float, Column("Position of the amplitudes, from the left support", 62.94, unit="m")]
    vertical_m: Annotated[float, Column("Vertical amplitude", 0.0502, unit="m")]
    horizontal_m: Annotated[float, Column("Horizontal amplitude", 0.0021, unit="m")]
    torsional_rad: Annotated[float, Column("Torsional amplitude", 0.0006, unit="rad")]
    stability: Annotated[Stability, Column("Stability of the motion; unknown if it could not be decided", "stable")]
    span: SpanColumn = None
    phase: PhaseColumn = None


@dataclass(frozen=True, slots=True)
class ModelComparisonRow:
    """A stable cycle of the hybrid model and the nearest cycle of the finite element model with the same loops.

    The columns of the finite element model are null if it has no cycle with these loops.
    """

    loops: Annotated[int, Column("Loops per span", 2, unit="1")]
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 4.0, unit="m/s")]
    branch: Annotated[int | None, Column("Family of the hybrid model's cycle", 0)]
    hybrid_vertical_m: Annotated[float, Column("Vertical amplitude of the hybrid model", 0.0994, unit="m")]
    hybrid_horizontal_m: Annotated[float, Column("Horizontal amplitude of the hybrid model", 0.3592, unit="m")]
    hybrid_torsional_rad: Annotated[float, Column("Torsional amplitude of the hybrid model", 0.0145, unit="rad")]
    finite_element_branch: Annotated[
        int | None, Column("Family of the finite element model's cycle; null if it has none with these loops", 2)
    ]
    finite_element_stability: Annotated[
        Stability | None, Column("Stability of the finite element model's cycle", "stable")
    ]
    finite_element_vertical_m: Annotated[
        float | None, Column("Vertical amplitude of the finite element model", 0.0776, unit="m")
    ]
    finite_element_horizontal_m: Annotated[
        float | None, Column("Horizontal amplitude of the finite element model", 0.3038, unit="m")
    ]
    finite_element_torsional_rad: Annotated[
        float | None, Column("Torsional amplitude of the finite element model", 0.0121, unit="rad")
    ]
    amplitude_difference: Annotated[
        float | None,
        Column("Difference of sqrt(vertical^2 + horizontal^2), relative to the hybrid model", -0.159, unit="1"),
    ]


@dataclass(frozen=True, slots=True)
class LoopCompetitionRow:
    """A stable cycle of the hybrid model, tested with motion in the other requested loops.

    The growth factor is the largest modulus of the Floquet multipliers except the trivial one.
    """

    loops: LoopsColumn
    wind_speed_m_per_s: Annotated[float, Column("Wind speed", 4.0, unit="m/s")]
    branch: Annotated[int, Column("Family of the cycle", 0)]
    stability: Annotated[Stability, Column("Stability when the other loops may move", "unstable")]
    growing_loops: Annotated[
        int | None, Column("Loops of the fastest-growing or slowest-decaying motion; null if unknown", 2, unit="1")
    ]
    growth_per_cycle: Annotated[
        float | None, Column("Growth factor of that motion per cycle; null if unknown", 1.0008, unit="1")
    ]
    vertical_m: Annotated[float | None, Column("Vertical amplitude when the other loops may move", 0.1303, unit="m")]
    horizontal_m: Annotated[
        float | None, Column("Horizontal amplitude when the other loops may move", 0.0101, unit="m")
    ]
    torsional_rad: Annotated[
        float | None, Column("Torsional amplitude when the other loops may move", 0.0895, unit="rad")
    ]
    outcome: OutcomeColumn


@dataclass(frozen=True, slots=True)
class Orbit:
    """Fourier coefficients of a cycle at the position where it is observed, for plots.

    cycle is the index into `Result.limit_cycles`. vertical and horizontal [m] and torsional [rad] each hold
    (mean, cos 1, sin 1, cos 2, sin 2, ...) of the base frequency.
    """

    cycle: int
    vertical: tuple[float, ...]
    horizontal: tuple[float, ...]
    torsional: tuple[float, ...]
