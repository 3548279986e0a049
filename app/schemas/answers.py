"""What goes out: states of jobs, result rows, health, and problems of RFC 9457."""

from datetime import datetime
from typing import Annotated, Any, Literal
from uuid import UUID

from pydantic import ConfigDict, Field

from app.reference.source_lines import example
from app.schemas.fields import Answer, example_of, told
from app.schemas.rows import (
    Bifurcation,
    CriticalWindSpeed,
    DenHartog,
    DeviceEffect,
    FollowedBifurcation,
    FollowedCycle,
    Frequency,
    InternalResonance,
    LimitCycle,
    LoopCompetition,
    ModelComparison,
    PlacedDevice,
    StaticState,
)

Status = Literal["accepted", "running", "successful", "failed", "dismissed"]


class Failure(Answer):
    """Why a job failed: its input or model, or the service."""

    kind: Literal["input", "no_convergence", "time_limit", "worker_lost", "internal"] = told(
        "Who is to act: input, no_convergence and time_limit concern the line, the others the service", "time_limit"
    )
    detail: str | None = told("Why, in a sentence", "The job ran longer than 3600 s.")


class PointFailure(Answer):
    """Why a point of a study failed, after the values of the axes."""

    model_config = ConfigDict(extra="allow", frozen=True)

    failure: str = told("Why, in a sentence", "InvalidSpec: devices.0.position must lie on the span")


TableName = Literal[
    "frequencies",
    "internal-resonances",
    "critical-wind-speeds",
    "limit-cycles",
    "bifurcations",
    "model-comparisons",
    "loop-competitions",
    "device-effects",
    "placements",
    "followed-cycles",
    "followed-bifurcations",
]
"""Tables of flat rows as addresses name them, in the order of the result document."""


class ResultDocument(Answer):
    """Everything that was found; in a study every row begins with the values of the axes."""

    input: dict[str, Any] = told("What was asked, with every default that was taken", {"line": example("c11-twin")})
    static: StaticState | list[StaticState] | None = told("Static state of the span", example_of(StaticState))
    den_hartog: DenHartog | list[DenHartog] | None = told("Den Hartog's criterion", example_of(DenHartog))
    frequencies: list[Frequency] = told("Natural frequencies", [example_of(Frequency)])
    internal_resonances: list[InternalResonance] = told(
        "Ratios of the natural frequencies", [example_of(InternalResonance)]
    )
    critical_wind_speeds: list[CriticalWindSpeed] = told(
        "Wind speeds at which the resting span loses or regains stability", [example_of(CriticalWindSpeed)]
    )
    limit_cycles: list[LimitCycle] = told(
        "Motions at every wind speed", [example_of(LimitCycle) | {"kind": "quasi_periodic"}]
    )
    bifurcations: list[Bifurcation] = told("Changes of the motions over the wind speed", [example_of(Bifurcation)])
    model_comparisons: list[ModelComparison] = told(
        "Stable cycles of the hybrid model beside the finite element model's", [example_of(ModelComparison)]
    )
    loop_competitions: list[LoopCompetition] = told(
        "Stable cycles against the other loops; empty unless loop_competition is checked", [example_of(LoopCompetition)]
    )
    device_effects: list[DeviceEffect] = told(
        "Without and with devices; empty unless device_effect is reported or devices were placed",
        [example_of(DeviceEffect)],
    )
    placements: list[PlacedDevice] = told("Devices that a search has placed", [example_of(PlacedDevice)])
    followed_cycles: list[FollowedCycle] = told(
        "Cycles on branches over the field of a study; empty unless it has follow", [example_of(FollowedCycle)]
    )
    followed_bifurcations: list[FollowedBifurcation] = told(
        "Where those branches turn, begin or change, with the nearest value of the axis",
        [example_of(FollowedBifurcation)],
    )
    warnings: list[str] = told("What to bear in mind, in sentences", ["The angle of attack leaves the fitted range."])
    failures: list[PointFailure] = told("Points that failed", [example_of(PointFailure)])
    failure: Failure | None = told("Why the job failed; null if it did not", example_of(Failure))
    engine_version: str | None = told("Version of the computation; null if nothing was computed", "0.1.0")


class Link(Answer):
    """Where to go on."""

    rel: str = told("What lies there", "self")
    href: str = told("Address", "/v1/jobs/0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")


class JobDocument(Answer):
    """State of a job."""

    id: UUID = told("Identity of the job", "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d8e")
    status: Status = told("State; the last three are final", "running")
    progress: Annotated[float, Field(ge=0.0, le=1.0)] = told("How much is done, 0 to 1 [1]", 0.4)
    step: str = told("What is being done", "limit cycles, hybrid, 1 loop")
    name: str | None = told("Name of the line", "C11 twin, 126 m")
    asset_id: str | None = told("Identity of the line in the owner's records", "L204-S017")
    tags: dict[str, str] = told("Labels of the line", {"region": "north"})
    created_at: datetime = told("When the job was accepted", "2026-11-22T10:00:00+00:00")
    started_at: datetime | None = told("When its last attempt began", "2026-11-22T10:00:01+00:00")
    finished_at: datetime | None = told("When it ended", "2026-11-22T10:00:05+00:00")
    attempt: int = told("Attempts so far; another follows if a worker is lost [1]", 1)
    cancel_requested: bool = told("Whether the running job was asked to stop", False)
    failure: Failure | None = told("Why it failed; null if it did not", example_of(Failure))
    engine_version: str | None = told("Version of the computation; null before it", "0.1.0")
    reused_from: UUID | None = told(
        "Job, or chunk of a batch, whose stored results of the same input these are; null if they were computed",
        "0199a3c4-5b7e-7c1a-9d2e-3f4a5b6c7d80",
    )
    links: list[Link] = told("Where to go on", [example_of(Link)])


class JobPage(Answer):
    """Some jobs, newest first."""

    jobs: list[JobDocument] = told("The jobs of the page", [example_of(JobDocument)])
    next: str | None = told(
        "Address of the next page; null on the last", "/v1/jobs?limit=50&cursor=AZmjxFt-fBqdLj9KW2x9jg"
    )


class Health(Answer):
    """Whether the service lives or can take work; `checks` says what was looked at."""

    status: Literal["ok", "unavailable"] = told("Whether all is well", "ok")
    checks: dict[str, str] = told(
        "What was looked at, and how it is", {"database": "ok", "migrations": "ok", "broker": "ok"}
    )


class FaultItem(Answer):
    """One fault of a request."""

    pointer: str = told("JSON pointer of the field; /query/... and /path/... for parameters", "/line/span/length_m")
    code: str = told("The kind of fault, for programs", "greater_than_equal")
    detail: str = told("What is wrong, in a sentence", "input should be greater than or equal to 1, got -5.0")


class Problem(Answer):
    """Problem details of RFC 9457."""

    model_config = ConfigDict(extra="allow", frozen=True)

    type: str = told("Address of the page that explains this type", "/problems/invalid-document")
    title: str = told("The type in words", "Invalid document")
    status: int = told("Status code of the answer [1]", 422)
    detail: str = told("What is wrong this time", "The document has 1 fault.")
    instance: str = told("Address that was asked", "/v1/jobs")
    errors: list[FaultItem] = Field(
        default=[], description="Every fault of the request", examples=[[example_of(FaultItem)]]
    )
    links: list[Link] = Field(default=[], description="Where to go on", examples=[[example_of(Link)]])


class ProblemPage(Answer):
    """What a type of problem means."""

    slug: str = told("Last part of its address", "not-found")
    status: int = told("Status code that it comes with [1]", 404)
    title: str = told("The type in words", "Not found")
    description: str = told("What it means", "There is nothing at this address, or no longer.")
