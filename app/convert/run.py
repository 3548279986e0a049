"""A validated request -> the engine -> plain rows, one point of the study after another."""

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache
from typing import Any, Literal

from app import schemas
from app.convert import study
from app.convert.assemble import SoundParts, gather
from engine import ENGINE_VERSION, spec
from engine.outcome import InvalidSpec
from engine.result import Result

Table = Literal["frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations"]
TABLES: tuple[Table, ...] = ("frequencies", "critical_wind_speeds", "limit_cycles", "bifurcations")


@dataclass(frozen=True)
class Advance:
    """How far a job is: fraction from 0 to 1 and the step at hand in words."""

    fraction: float
    step: str


@dataclass(frozen=True)
class PointResult:
    """Everything found at one point of a study, as plain values; failure is the sentence why there is nothing."""

    point: int
    axes: dict[str, object]
    static: dict[str, Any]
    den_hartog: dict[str, Any]
    tables: dict[str, list[dict[str, object]]]
    orbits: list[dict[str, object]]
    warnings: list[str]
    engine_version: str
    failure: str | None


def run(document: Mapping[str, object]) -> Iterator[Advance | PointResult]:
    """Run a whole job.

    Parameters
    ----------
    document : mapping
        A request as `app.convert.read` takes it.

    Yields
    ------
    Advance or PointResult
        Progress, and the result of each point as it is done; a point of a study that fails has its failure.

    Raises
    ------
    pydantic.ValidationError
        If the document does not pass its schema.
    ValueError, ArithmeticError
        If the line of a job without study is at fault (`InvalidSpec`) or numerically out of reach.
    """
    request = schemas.JobRequest.model_validate(document)
    total = study.count(request.study)
    for number, values in enumerate(study.points(request.study)):
        prefix = f"point {number + 1} of {total}: " if request.study else ""
        for item in _point(request, number, values):
            if isinstance(item, Advance):
                yield Advance((number + item.fraction) / total, prefix + item.step)
            else:
                yield item
    yield Advance(1.0, "done")


def _point(request: schemas.JobRequest, number: int, values: dict[str, Any]) -> Iterator[Advance | PointResult]:
    from engine.analysis import analyse  # noqa: PLC0415 - the API and `galloping --help` need no solver

    try:
        line, analysis = _specification(request, values)
        progress = analyse(line, analysis)
        while True:
            try:
                step = next(progress)
            except StopIteration as end:
                yield point_result(end.value, number, values)
                return
            yield Advance(step.fraction, step.step)
    except (ArithmeticError, ValueError) as error:  # both also cover numpy's, and what a specification raises
        if request.study is None:
            raise
        yield failed_point(error, number, values)


def _specification(request: schemas.JobRequest, values: dict[str, Any]) -> tuple[spec.Line, spec.Analysis]:
    line, analysis, faults = gather(SoundParts.of(study.varied(request.line, values)), request.analysis)
    if line is None or faults:
        raise InvalidSpec(*faults)
    return line, analysis


def point_result(result: Result, number: int, values: dict[str, Any]) -> PointResult:
    """Return the engine's result of one point as plain values."""
    return PointResult(
        point=number,
        axes=values,
        static=_plain(result.static),
        den_hartog=_plain(result.den_hartog),
        tables={name: [_plain(row) for row in getattr(result, name)] for name in TABLES},
        orbits=[_plain(orbit) for orbit in result.orbits],
        warnings=list(result.warnings),
        engine_version=result.engine_version,
        failure=None,
    )


def failed_point(error: Exception, number: int, values: dict[str, Any]) -> PointResult:
    """Return a point that holds nothing but why it failed."""
    return PointResult(
        point=number,
        axes=values,
        static={},
        den_hartog={},
        tables={name: [] for name in TABLES},
        orbits=[],
        warnings=[],
        engine_version=ENGINE_VERSION,
        failure=f"{type(error).__name__}: {error}",
    )


def _plain(row: Any) -> dict[str, Any]:
    return {name: _value(getattr(row, name)) for name in _names(row.__class__)}


@cache
def _names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in dataclasses.fields(kind))


def _value(value: Any) -> Any:
    """Return a JSON value: the word of an enum, None for what is not finite, plain Python for numpy's scalars."""
    kind = type(value)
    if kind is float:  # the usual case comes first, since a batch has a hundred thousand of them a second
        return value if math.isfinite(value) else None
    if value is None or kind is str or kind is int or kind is bool:
        return value
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, tuple):
        return [_value(item) for item in value]
    plain = value.item() if hasattr(value, "item") else value
    return None if isinstance(plain, float) and not math.isfinite(plain) else plain
