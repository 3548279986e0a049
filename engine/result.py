"""What an analysis returns: flat rows, one fact a row, with the column names of the contract (units in the names)."""

from dataclasses import dataclass
from typing import Literal

from engine.outcome import Outcome, Stability
from engine.spec import Model, Objective

FoundBy = Literal[
    "hopf_branch", "explicit", "energy_balance", "direct_integration", "branch", "torus_point", "unstable_cycle"
]
Direction = Literal["vertical", "horizontal", "torsional"]


@dataclass(frozen=True, slots=True)
class StaticState:
    """Static state of the span, theory section 2; the stiffness is the smaller of both ends, None at dead ends.

    The twist is the largest on the span with its sign, None where it is neglected or was not found.
    """

    horizontal_tension_n: float
    catenary_parameter_m: float
    sag_m: float
    longitudinal_stiffness_n_per_m: float | None
    twist_rad: float | None


@dataclass(frozen=True, slots=True)
class DenHartog:
    """The coefficient a_y1 = dC_L/dalpha + C_D of one sub-conductor, the smallest on the span; negative is unstable."""

    coefficient: float
    unstable: bool


@dataclass(frozen=True, slots=True)
class FrequencyRow:
    """Natural frequencies without wind, labelled by dominant direction; numbers are None unless converged."""

    model: Model
    loops: int
    vertical_hz: float | None
    horizontal_hz: float | None
    torsional_hz: float | None
    outcome: Outcome = Outcome.CONVERGED


@dataclass(frozen=True, slots=True)
class InternalResonanceRow:
    """How near two natural frequencies without wind are to a ratio of small integers.

    directions and nearest_ratio stand in the same order, such as "torsional:vertical" and "2:1"; detuning is
    frequency_ratio over the nearest ratio, less 1.
    """

    model: Model
    loops: int
    directions: str
    frequency_ratio: float
    nearest_ratio: str
    detuning: float


@dataclass(frozen=True, slots=True)
class CriticalWindSpeedRow:
    """One crossing of the imaginary axis by eigenvalues of the static state, theory section 6."""

    model: Model
    loops: int
    wind_speed_m_per_s: float
    crossing: Literal["onset", "restabilization"]
    type: Literal["oscillation", "divergence"]
    direction: Direction
    frequency_hz: float
    unstable_pairs_after: int


@dataclass(frozen=True)  # without slots, since a line has dozens of these, which orjson writes by their `__dict__`
class LimitCycleRow:
    """One motion at one wind speed: the equilibrium or a cycle; amplitudes are half of peak-to-peak (section 8).

    The shares divide the mean kinetic energy between the directions; they are None where nothing moves.
    """

    model: Model
    loops: int
    wind_speed_m_per_s: float
    branch: int | None
    kind: Literal["equilibrium", "periodic", "quasi_periodic"]
    stability: Stability
    frequency_hz: float | None
    second_frequency_hz: float | None
    observed_at_m: float
    vertical_m: float | None
    horizontal_m: float | None
    torsional_rad: float | None
    vertical_min_m: float | None
    horizontal_min_m: float | None
    torsional_min_rad: float | None
    vertical_ratio: float | None
    horizontal_ratio: float | None
    reduced_wind_speed: float | None
    vertical_share: float | None
    horizontal_share: float | None
    torsional_share: float | None
    found_by: FoundBy | None
    harmonics: int | None
    residual: float | None
    truncation: float | None
    detuning_sensitivity: float | None
    direct_difference: float | None
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class BifurcationRow:
    """A point where the kind or the number of motions changes, with how well it is located."""

    model: Model
    loops: int
    branch: int
    type: Literal["hopf", "fold", "torus", "period_doubling", "branch_point"]
    wind_speed_m_per_s: float
    frequency_hz: float
    second_frequency_hz: float | None
    uncertainty_m_per_s: float


@dataclass(frozen=True, slots=True)
class ModelComparisonRow:
    """A stable cycle of the hybrid model beside the nearest of the finite element model with as many loops.

    The columns of the finite element model are None if it has no cycle of these loops; the difference is that of the
    amplitudes sqrt(V^2 + W^2), over the hybrid model's.
    """

    loops: int
    wind_speed_m_per_s: float
    branch: int | None
    hybrid_vertical_m: float
    hybrid_horizontal_m: float
    hybrid_torsional_rad: float
    finite_element_branch: int | None
    finite_element_stability: Stability | None
    finite_element_vertical_m: float | None
    finite_element_horizontal_m: float | None
    finite_element_torsional_rad: float | None
    amplitude_difference: float | None


@dataclass(frozen=True, slots=True)
class LoopCompetitionRow:
    """A cycle of the hybrid model that is stable alone, when the other loops asked for may move too.

    growing_loops: loops of the motion that grows fastest, or decays slowest; growth_per_cycle: its factor a cycle, the
    largest modulus of the Floquet multipliers beside the trivial one. Both are None where the stability is unknown.
    """

    loops: int
    wind_speed_m_per_s: float
    branch: int
    stability: Stability
    growing_loops: int | None
    growth_per_cycle: float | None
    vertical_m: float | None
    horizontal_m: float | None
    torsional_rad: float | None
    outcome: Outcome


@dataclass(frozen=True, slots=True)
class DeviceEffectRow:
    """Lowest onset and largest amplitude sqrt(V^2 + W^2) of a stable motion, without and with devices.

    A critical wind speed is None if there is no onset up to the limit; an amplitude is None where no wind speed was
    asked for or no stable motion is known, 0 where the line rests.
    """

    model: Model
    loops: int
    wind_speed_m_per_s: float | None
    critical_wind_speed_without_m_per_s: float | None
    critical_wind_speed_with_m_per_s: float | None
    amplitude_without_m: float | None
    amplitude_with_m: float | None


@dataclass(frozen=True, slots=True)
class PlacementRow:
    """A device that a search has placed, its number among the devices of the line, and how the search went.

    objective_value: the lowest onset reached [m/s] (the limit if there is none below), or the largest amplitude [m];
    None if no candidate has a value.
    """

    device: int
    type: Literal["detuning_pendulum", "airflow_spoiler"]
    position_m: float | None
    mass_kg: float | None
    arm_m: float | None
    from_m: float | None
    to_m: float | None
    objective: Objective
    objective_value: float | None
    evaluations: int
    generations: int


@dataclass(frozen=True, slots=True)
class FollowedCycleRow:
    """A cycle of the hybrid model on a branch that was followed over the field of a study, at one of its values.

    branch numbers the connected families over the field, for each number of loops and wind speed from 0; found_by is
    "point" where the analysis of the value alone has the cycle too.
    """

    loops: int
    wind_speed_m_per_s: float
    branch: int
    stability: Stability
    frequency_hz: float
    observed_at_m: float
    vertical_m: float
    horizontal_m: float
    torsional_rad: float
    found_by: Literal["point", "field_branch"]


@dataclass(frozen=True, slots=True)
class FollowedBifurcationRow:
    """A bifurcation on a branch that was followed over the field of a study; value and uncertainty in its own unit."""

    loops: int
    wind_speed_m_per_s: float
    branch: int
    type: Literal["hopf", "fold", "torus", "period_doubling", "branch_point"]
    value: float
    frequency_hz: float
    second_frequency_hz: float | None
    uncertainty: float


@dataclass(frozen=True, slots=True)
class Orbit:
    """Fourier coefficients of a cycle where it is observed, for pictures.

    cycle is the index into `Result.limit_cycles`. vertical and horizontal [m] and torsional [rad] each hold
    (mean, cos 1, sin 1, cos 2, sin 2, ...) of the base frequency.
    """

    cycle: int
    vertical: tuple[float, ...]
    horizontal: tuple[float, ...]
    torsional: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Result:
    """Everything that was found for one line."""

    static: StaticState
    den_hartog: DenHartog
    frequencies: tuple[FrequencyRow, ...]
    internal_resonances: tuple[InternalResonanceRow, ...]
    critical_wind_speeds: tuple[CriticalWindSpeedRow, ...]
    limit_cycles: tuple[LimitCycleRow, ...]
    bifurcations: tuple[BifurcationRow, ...]
    model_comparisons: tuple[ModelComparisonRow, ...]
    loop_competitions: tuple[LoopCompetitionRow, ...]
    device_effects: tuple[DeviceEffectRow, ...]
    placements: tuple[PlacementRow, ...]
    followed_cycles: tuple[FollowedCycleRow, ...]
    followed_bifurcations: tuple[FollowedBifurcationRow, ...]
    orbits: tuple[Orbit, ...]
    warnings: tuple[str, ...]
    engine_version: str


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an analysis is: fraction from 0 to 1 and the step at hand in words."""

    fraction: float
    step: str
