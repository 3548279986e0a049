"""What goes out: states of jobs, result rows, health, and problems of RFC 9457."""

from datetime import datetime
from typing import Annotated, Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.schemas.fields import Answer

Status = Literal["accepted", "running", "successful", "failed", "dismissed"]
Model = Literal["hybrid", "finite_element"]
Outcome = Literal["converged", "no_convergence", "statically_unstable", "outside_fit", "limit_reached"]
Number = float | None


class Row(Answer):
    """A result row; in a study the values of the axes stand before these columns."""

    model_config = ConfigDict(extra="allow", frozen=True)

    model: Model = Field(description="Model that the row comes from")
    loops: int = Field(description="Loops per span [1]")


class Frequency(Row):
    """Natural frequencies without wind, labelled by dominant direction."""

    vertical_hz: Number = Field(description="[Hz]")
    horizontal_hz: Number = Field(description="[Hz]")
    torsional_hz: Number = Field(description="[Hz]")
    outcome: Outcome


class CriticalWindSpeed(Row):
    """A wind speed at which the resting span loses or regains stability."""

    wind_speed_m_per_s: float = Field(description="[m/s]")
    crossing: Literal["onset", "restabilization"]
    type: Literal["oscillation", "divergence"]
    direction: Literal["vertical", "horizontal", "torsional"]
    frequency_hz: float = Field(description="0 for a divergence [Hz]")
    unstable_pairs_after: int = Field(description="Unstable pairs of eigenvalues above this wind speed [1]")


class LimitCycle(Row):
    """A motion at one wind speed; amplitudes are half of peak-to-peak."""

    wind_speed_m_per_s: float = Field(description="[m/s]")
    branch: int | None = Field(description="Family of cycles; null for the equilibrium")
    kind: Literal["equilibrium", "periodic", "quasi_periodic"]
    stability: Literal["stable", "unstable", "unknown"]
    frequency_hz: Number = Field(description="[Hz]")
    second_frequency_hz: Number = Field(description="Of a quasi-periodic motion [Hz]")
    observed_at_m: float = Field(description="Where the amplitudes hold, from the left support [m]")
    vertical_m: Number = Field(description="[m]")
    horizontal_m: Number = Field(description="[m]")
    torsional_rad: Number = Field(description="[rad]")
    vertical_min_m: Number = Field(description="Smaller amplitude of a quasi-periodic motion [m]")
    horizontal_min_m: Number = Field(description="[m]")
    torsional_min_rad: Number = Field(description="[rad]")
    vertical_ratio: Number = Field(description="Over the static sag [1]")
    horizontal_ratio: Number = Field(description="Over the static sag [1]")
    reduced_wind_speed: Number = Field(description="Wind speed over frequency and span [1]")
    outcome: Outcome


class Bifurcation(Row):
    """A wind speed at which the kind or the number of motions changes."""

    branch: int
    type: Literal["hopf", "fold", "torus", "period_doubling", "branch_point"]
    wind_speed_m_per_s: float = Field(description="[m/s]")
    frequency_hz: float = Field(description="[Hz]")
    second_frequency_hz: Number = Field(description="[Hz]")
    uncertainty_m_per_s: float = Field(description="How well the place is known [m/s]")


class StaticState(Answer):
    """Static state of the span; in a study one row a point, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    horizontal_tension_n: Number = Field(description="[N]")
    catenary_parameter_m: Number = Field(description="[m]")
    sag_m: Number = Field(description="[m]")
    longitudinal_stiffness_n_per_m: Number = Field(description="Null at dead ends [N/m]")


class DenHartog(Answer):
    """Den Hartog's criterion; in a study one row a point, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    coefficient: Number = Field(description="dC_L/dalpha + C_D of one sub-conductor [1/rad]")
    unstable: bool | None


class Failure(Answer):
    """Why a job failed: its input or model, or the service."""

    kind: Literal["input", "no_convergence", "time_limit", "worker_lost", "internal"]
    detail: str | None


class PointFailure(Answer):
    """Why a point of a study failed, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    failure: str


class ResultDocument(Answer):
    """Everything that was found; in a study every row begins with the values of the axes."""

    static: StaticState | list[StaticState] | None
    den_hartog: DenHartog | list[DenHartog] | None
    frequencies: list[Frequency]
    critical_wind_speeds: list[CriticalWindSpeed]
    limit_cycles: list[LimitCycle]
    bifurcations: list[Bifurcation]
    warnings: list[str]
    failures: list[PointFailure] = Field(description="Points that failed")
    failure: Failure | None = Field(description="Why the job failed; null if it did not")
    engine_version: str | None


class Link(Answer):
    """Where to go on."""

    rel: str
    href: str


class JobDocument(Answer):
    """State of a job."""

    id: UUID
    status: Status
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = Field(description="How much is done, 0 to 1 [1]")
    step: str = Field(description="What is being done")
    name: str | None
    asset_id: str | None
    tags: dict[str, str]
    created_at: datetime
    started_at: datetime | None
    finished_at: datetime | None
    attempt: int
    cancel_requested: bool
    failure: Failure | None
    engine_version: str | None
    links: list[Link]


class JobPage(Answer):
    """Some jobs, newest first."""

    jobs: list[JobDocument]
    next: str | None = Field(description="Address of the next page; null on the last")


class Health(Answer):
    """Whether the service lives or can take work; `checks` says what was looked at."""

    status: Literal["ok", "unavailable"]
    checks: dict[str, str]


class FaultItem(Answer):
    """One fault of a request."""

    pointer: str = Field(description="JSON pointer of the field; /query/... and /path/... for parameters")
    code: str
    detail: str


class Problem(Answer):
    """Problem details of RFC 9457."""

    model_config = ConfigDict(extra="allow", frozen=True)

    type: str
    title: str
    status: int
    detail: str
    instance: str
    errors: list[FaultItem] = Field(default=[], description="Every fault of the request")
    links: list[Link] = Field(default=[], description="Where to go on")


class ProblemPage(Answer):
    """What a type of problem means."""

    slug: str
    status: int
    title: str
    description: str
