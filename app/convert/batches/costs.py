"""Estimate the computing time of lines from measured costs, by what their analysis asks for."""

from dataclasses import dataclass

from app import schemas
from app.convert import study

# Seconds on one core for a line in a stack, fixed and per wind speed, rounded from `benchmarks.line_costs`: under the
# source's physics, under full physics, with an unexpanded load, and with tables, where every wind speed has models.
_HYBRID_SECONDS = {
    "source": (0.0015, 0.0001),
    "full": (0.0015, 0.00015),
    "unexpanded": (0.07, 0.008),
    "table": (0.02, 0.0015),
}  # for each number of loops
_HYBRID_DIRECT_SECONDS = (0.6, 0.2)
_FINITE_ELEMENT_SECONDS = {
    "source": (0.3, 0.008),
    "full": (0.35, 0.008),
    "unexpanded": (0.6, 0.05),
    "table": (0.05, 0.02),
}
_FINITE_ELEMENT_DIRECT_SECONDS = (45.0, 1.5)
_FULL_MODES_SECONDS = 0.0002
_STATIC_TWIST_SECONDS = 0.0005
_COMPETITION_SECONDS = 0.0005  # a cycle
_ENDS_OF_RANGES = 30  # lines beside the samples of a line: two for each value that is assumed


def seconds_a_line(analysis: schemas.Analysis) -> float:
    """Estimate the time of a line in a stack on one core [s], to cut a batch into chunks of equal work."""
    winds, direct, load = len(analysis.speeds()), analysis.check == "direct", _load(analysis)

    def motions(*costs: tuple[float, float]) -> float:
        return sum(fixed + per_wind * winds for fixed, per_wind in costs[: 1 + direct])

    cost = len(analysis.loops) * motions(_HYBRID_SECONDS[load], _HYBRID_DIRECT_SECONDS)
    if "finite_element" in analysis.models:
        cost += _FULL_MODES_SECONDS
        if analysis.finite_element_loops:
            cost += motions(_FINITE_ELEMENT_SECONDS[load], _FINITE_ELEMENT_DIRECT_SECONDS)
    if analysis.static_twist in ("solved", "where_large"):
        cost += _STATIC_TWIST_SECONDS
    if analysis.loop_competition == "checked":
        cost += _COMPETITION_SECONDS * len(analysis.loops) * winds
    if analysis.device_effect == "reported":
        cost *= 2.0
    samples = 0 if analysis.uncertainty is None else analysis.uncertainty.samples
    return cost + (samples + _ENDS_OF_RANGES if samples else 0) * len(analysis.loops) * motions(_HYBRID_SECONDS[load])


def _load(analysis: schemas.Analysis) -> str:
    """Return which cost an analysis has; physics that the lines' data decide count as full."""
    if analysis.aerodynamic_model == "table":
        return "table"
    if analysis.aerodynamic_load == "unexpanded" and analysis.aerodynamic_model != "published":
        return "unexpanded"
    own = analysis.aerodynamic_model == "relative_wind" or analysis.stretching == "included"
    source = analysis.physics == "source" or (analysis.physics is None and analysis.closure == "published")
    return "source" if source and not own else "full"


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a job costs: its points, and seconds on one core, None where searches decide them."""

    points: int
    seconds: float | None


def estimate(request: schemas.JobRequest) -> Estimate:
    """Estimate what a job costs, but for the seconds of a placement or of remedies, which search.

    Every point of a study counts as a line in a stack. A line whose values are assumed has its samples, whether or not
    the analysis names them.
    """
    if request.placement is not None or request.remedies is not None:
        return Estimate(1, None)
    analysis = request.analysis
    if analysis.uncertainty is None and request.known is not None and request.study is None:
        analysis = analysis.model_copy(update={"uncertainty": schemas.Uncertainty()})
    points = study.count(request.study)
    return Estimate(points, points * seconds_a_line(analysis))
