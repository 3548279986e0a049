"""Rows of results: what the columns of each table mean, with their units."""

from typing import Literal

from pydantic import ConfigDict

from app.schemas.fields import Answer, told

Model = Literal["hybrid", "finite_element"]
Outcome = Literal["converged", "no_convergence", "statically_unstable", "outside_fit", "limit_reached"]
FoundBy = Literal[
    "hopf_branch", "explicit", "energy_balance", "direct_integration", "branch", "torus_point", "unstable_cycle"
]
Number = float | None


class Row(Answer):
    """A result row; in a study the values of the axes stand before these columns."""

    model_config = ConfigDict(extra="allow", frozen=True)

    model: Model = told("Model that the row comes from", "hybrid")
    loops: int = told("Loops per span [1]", 1)


class Frequency(Row):
    """Natural frequencies without wind, labelled by dominant direction."""

    vertical_hz: Number = told("Dominantly vertical [Hz]", 0.4816)
    horizontal_hz: Number = told("Dominantly horizontal [Hz]", 0.4460)
    torsional_hz: Number = told("Dominantly torsional [Hz]", 0.6343)
    outcome: Outcome = told("How the computation ended", "converged")


class InternalResonance(Row):
    """How near two natural frequencies without wind are to a ratio of small integers."""

    directions: str = told("Whose frequencies are compared, in this order", "horizontal:vertical")
    frequency_ratio: float = told("The first frequency over the second [1]", 0.9261)
    nearest_ratio: str = told("Nearest ratio of integers up to 3", "1:1")
    detuning: float = told("Frequency ratio over the nearest one, less 1 [1]", -0.0739)


class CriticalWindSpeed(Row):
    """A wind speed at which the resting span loses or regains stability."""

    wind_speed_m_per_s: float = told("Wind speed of the crossing [m/s]", 2.403)
    crossing: Literal["onset", "restabilization"] = told("Whether stability is lost or regained", "onset")
    type: Literal["oscillation", "divergence"] = told("Whether what grows oscillates", "oscillation")
    direction: Literal["vertical", "horizontal", "torsional"] = told("Dominant direction of what grows", "vertical")
    frequency_hz: float = told("0 for a divergence [Hz]", 0.4816)
    unstable_pairs_after: int = told("Unstable pairs of eigenvalues above this wind speed [1]", 1)


class LimitCycle(Row):
    """A motion at one wind speed; amplitudes are half of peak-to-peak."""

    wind_speed_m_per_s: float = told("Wind speed [m/s]", 4.0)
    branch: int | None = told("Family of cycles; null for the equilibrium", 0)
    kind: Literal["equilibrium", "periodic", "quasi_periodic"] = told("Rest, or what kind of motion", "periodic")
    stability: Literal["stable", "unstable", "unknown"] = told(
        "Whether the motion lasts; unknown if it was not decided", "stable"
    )
    frequency_hz: Number = told("Frequency; null for the equilibrium [Hz]", 0.4816)
    second_frequency_hz: Number = told("Of a quasi-periodic motion [Hz]", 0.0121)
    observed_at_m: float = told("Where the amplitudes hold, from the left support [m]", 62.94)
    vertical_m: Number = told("Vertical amplitude [m]", 0.1568)
    horizontal_m: Number = told("Horizontal amplitude [m]", 0.0099)
    torsional_rad: Number = told("Torsional amplitude [rad]", 0.0020)
    vertical_min_m: Number = told("Smaller vertical amplitude of a quasi-periodic motion [m]", 0.1204)
    horizontal_min_m: Number = told("Smaller horizontal amplitude of a quasi-periodic motion [m]", 0.0061)
    torsional_min_rad: Number = told("Smaller torsional amplitude of a quasi-periodic motion [rad]", 0.0013)
    vertical_ratio: Number = told("Vertical amplitude over the static sag [1]", 0.1018)
    horizontal_ratio: Number = told("Horizontal amplitude over the static sag [1]", 0.0064)
    reduced_wind_speed: Number = told("Wind speed over frequency and span [1]", 0.066)
    vertical_share: Number = told("Vertical share of the mean kinetic energy; null at rest [1]", 0.9927)
    horizontal_share: Number = told("Horizontal share of the mean kinetic energy; null at rest [1]", 0.0034)
    torsional_share: Number = told("Torsional share of the mean kinetic energy; null at rest [1]", 0.0039)
    found_by: FoundBy | None = told(
        "How it was found: on the branch of a Hopf point, from the explicit formula, the balance of energy or direct "
        "integration, on the branch of such a one; if quasi-periodic from a torus point or beside an unstable cycle; "
        "null at rest",
        "hopf_branch",
    )
    harmonics: int | None = told(
        "Harmonics of the balance, of the cycle's frequency if quasi-periodic; null at rest [1]", 5
    )
    residual: Number = told("Largest rest of the equations over the largest elastic force [1]", 2.1e-13)
    truncation: Number = told("Relative change of the amplitude with one harmonic more [1]", 3.4e-8)
    detuning_sensitivity: Number = told(
        "Relative change of the amplitude if the horizontal frequency rises by 0.1 % [1]", -0.0031
    )
    direct_difference: Number = told(
        "Relative change of the amplitude in 50 periods of direct integration; null unless check is direct [1]", 2.6e-5
    )
    outcome: Outcome = told("How the computation ended", "converged")


class Bifurcation(Row):
    """A wind speed at which the kind or the number of motions changes."""

    branch: int = told("Family of cycles", 0)
    type: Literal["hopf", "fold", "torus", "period_doubling", "branch_point"] = told("What happens there", "torus")
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 6.82)
    frequency_hz: float = told("Frequency of the motion there [Hz]", 0.4816)
    second_frequency_hz: Number = told("Second frequency that begins there [Hz]", 0.0121)
    uncertainty_m_per_s: float = told("How well the place is known [m/s]", 0.01)


class ModelComparison(Answer):
    """A stable cycle of the hybrid model beside the nearest of the finite element model with as many loops."""

    model_config = ConfigDict(extra="allow", frozen=True)

    loops: int = told("Loops per span [1]", 2)
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 4.0)
    branch: int | None = told("Family of the hybrid model's cycle", 0)
    hybrid_vertical_m: float = told("Vertical amplitude of the hybrid model [m]", 0.0994)
    hybrid_horizontal_m: float = told("Horizontal amplitude of the hybrid model [m]", 0.3592)
    hybrid_torsional_rad: float = told("Torsional amplitude of the hybrid model [rad]", 0.0145)
    finite_element_branch: int | None = told("Family of the other cycle; null if there is none of these loops", 2)
    finite_element_stability: Literal["stable", "unstable", "unknown"] | None = told("Whether it lasts", "stable")
    finite_element_vertical_m: Number = told("Vertical amplitude of the finite element model [m]", 0.0776)
    finite_element_horizontal_m: Number = told("Horizontal amplitude of the finite element model [m]", 0.3038)
    finite_element_torsional_rad: Number = told("Torsional amplitude of the finite element model [rad]", 0.0121)
    amplitude_difference: Number = told("Of sqrt(vertical^2 + horizontal^2), over the hybrid model's [1]", -0.159)


class LoopCompetition(Answer):
    """A cycle of the hybrid model that is stable alone, when the other loops asked for may move too."""

    model_config = ConfigDict(extra="allow", frozen=True)

    loops: int = told("Loops per span [1]", 1)
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 4.0)
    branch: int | None = told("Family of the cycle", 0)
    stability: Literal["stable", "unstable", "unknown"] = told("Whether it survives the other loops", "unstable")
    growing_loops: int | None = told("Loops of what grows fastest or decays slowest; null if unknown [1]", 2)
    growth_per_cycle: Number = told("Factor of that motion a cycle; null if unknown [1]", 1.0008)
    vertical_m: Number = told("Vertical amplitude among the other loops [m]", 0.1303)
    horizontal_m: Number = told("Horizontal amplitude among the other loops [m]", 0.0101)
    torsional_rad: Number = told("Torsional amplitude among the other loops [rad]", 0.0895)
    outcome: Outcome = told("How the computation ended", "converged")


class DeviceEffect(Answer):
    """Lowest onset and largest stable amplitude, without and with devices."""

    model_config = ConfigDict(extra="allow", frozen=True)

    model: Model = told("Model that the row comes from", "hybrid")
    loops: int = told("Loops per span [1]", 2)
    wind_speed_m_per_s: Number = told("Wind speed of the amplitudes; null if none was asked for [m/s]", 4.0)
    critical_wind_speed_without_m_per_s: Number = told("Lowest onset without; null if there is none [m/s]", 2.25)
    critical_wind_speed_with_m_per_s: Number = told("Lowest onset with them; null if there is none [m/s]", 2.59)
    amplitude_without_m: Number = told("Largest sqrt(V^2 + W^2) without; 0 at rest, null if unknown [m]", 0.373)
    amplitude_with_m: Number = told("Largest sqrt(V^2 + W^2) with them; 0 at rest, null if unknown [m]", 0.096)


class PlacedDevice(Answer):
    """A device that a search has placed."""

    model_config = ConfigDict(extra="allow", frozen=True)

    device: int = told("Its number among the devices of the line, from 0 [1]", 0)
    type: Literal["detuning_pendulum", "airflow_spoiler"] = told("Kind of device", "detuning_pendulum")
    position_m: Number = told("Where a pendulum hangs [m]", 68.5)
    mass_kg: Number = told("Mass of a pendulum [kg]", 19.9)
    arm_m: Number = told("Arm of a pendulum [m]", 0.46)
    from_m: Number = told("Where a spoiler begins [m]", None)
    to_m: Number = told("Where a spoiler ends [m]", None)
    objective: Literal["highest_critical_wind_speed", "lowest_amplitude"] = told(
        "What was sought", "highest_critical_wind_speed"
    )
    objective_value: Number = told("What was reached, in m/s or m; null if no place has a value", 2.547)
    evaluations: int = told("Different candidates that were computed [1]", 80)
    generations: int = told("Generations of the search [1]", 4)


class FollowedCycle(Answer):
    """A cycle of the hybrid model on a branch over the field of a study, at one of its values."""

    model_config = ConfigDict(extra="allow", frozen=True)

    loops: int = told("Loops per span [1]", 1)
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 5.32)
    branch: int = told("Family over the field, for each number of loops and wind speed from 0", 1)
    stability: Literal["stable", "unstable", "unknown"] = told("Whether it lasts", "stable")
    frequency_hz: float = told("Frequency [Hz]", 0.4819)
    observed_at_m: float = told("Horizontal position of the amplitudes, from the left support [m]", 62.94)
    vertical_m: float = told("Vertical amplitude [m]", 0.1128)
    horizontal_m: float = told("Horizontal amplitude [m]", 0.0089)
    torsional_rad: float = told("Torsional amplitude [rad]", 0.1213)
    found_by: Literal["point", "field_branch"] = told("Whether the point alone has it too", "point")


class FollowedBifurcation(Answer):
    """A bifurcation on a branch over the field of a study; value and uncertainty are in the field's unit."""

    model_config = ConfigDict(extra="allow", frozen=True)

    loops: int = told("Loops per span [1]", 1)
    wind_speed_m_per_s: float = told("Wind speed [m/s]", 5.32)
    branch: int = told("Family over the field, for each number of loops and wind speed from 0", 1)
    type: Literal["hopf", "fold", "torus", "period_doubling", "branch_point"] = told("Kind of change", "fold")
    value: float = told("Value of the field, in its own unit", 0.0099985)
    frequency_hz: float = told("Frequency there [Hz]", 0.4819)
    second_frequency_hz: Number = told("Second frequency that begins there [Hz]", None)
    uncertainty: float = told("How well the value is known, in its own unit", 6e-7)


class StaticState(Answer):
    """Static state of the span; in a study one row a point, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    horizontal_tension_n: Number = told("Horizontal tension of one iced sub-conductor [N]", 30000.0)
    catenary_parameter_m: Number = told("Tension over weight per length [m]", 1285.46)
    sag_m: Number = told("Sag at mid-span [m]", 1.5412)
    longitudinal_stiffness_n_per_m: Number = told(
        "Longitudinal stiffness of the supports; null at dead ends [N/m]", 128460.7
    )
    twist_rad: Number = told("Largest static twist of the sections; null where it is neglected [rad]", -0.75)


class DenHartog(Answer):
    """Den Hartog's criterion; in a study one row a point, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    coefficient: Number = told("dC_L/dalpha + C_D of one sub-conductor [1/rad]", -0.1667)
    unstable: bool | None = told("Whether the coefficient is negative; null if it is unknown", True)
