"""Time of samples of what is assumed of a line: a twin bundle as an engineer knows it, two loops, 11 wind speeds."""

import statistics
import time
from collections.abc import Iterator, Mapping
from itertools import chain

import numpy as np

from app.convert.known.own_rows import OwnRows
from app.convert.known.to_engine import known_line
from app.schemas.known import KnownLine
from engine.known.resolve import resolve
from engine.progress import finished
from engine.spec import Analysis, Line, Model, PhysicsRequest, Uncertainty, with_physics, with_section
from engine.uncertainty.runs import outcomes
from engine.uncertainty.sampling import sobol_samples
from engine.uncertainty.tables import ends, sensitivity_rows, uncertainty_rows
from engine.uncertainty.weighing import intervals

TWIN_DRAKE = {
    "conductor": {"catalogue": "Drake"},
    "bundle": {"subconductors": 2, "spacing_m": 0.457, "arrangement": "horizontal"},
    "span": {
        "length_m": 300.0,
        "ruling_span_m": 305.0,
        "temperature_c": -5.0,
        "everyday": {"temperature_c": 15.0, "share_of_rated_strength": 0.20},
    },
    "ice": {
        "accretion": {"shape": "crescent", "thickness_m": 0.012, "density_kg_per_m3": 900.0, "angle_deg": 0.0},
        "aerodynamics": {"catalogue": "c11-40"},
    },
}
WINDS = tuple(np.linspace(2.0, 12.0, 11).tolist())


def samples() -> Iterator[tuple[str, float]]:
    """Yield the processor time of 64 and of 1,024 samples, with their indices and the ends of all ranges [s]."""
    yield "samples_64_seconds", statistics.median([_seconds(64) for _ in range(3)])
    yield "samples_1024_seconds", _seconds(1024)


def _seconds(count: int) -> float:
    known = known_line(KnownLine.model_validate(TWIN_DRAKE), OwnRows())
    resolved = resolve(known)
    analysis = with_physics(
        resolved.line, Analysis(loops=(1, 2), models=(Model.HYBRID,), wind_speeds=WINDS), PhysicsRequest()
    )
    asked = Uncertainty(count)

    def line_of(chosen: Mapping[str, float]) -> Line:
        return with_section(resolve(known, chosen).line, analysis.physics)

    begin = time.process_time()
    drawn = sobol_samples(intervals(resolved.assumptions), asked.samples, asked.seed)
    chosen = [*drawn.chosen(), *chain.from_iterable(ends(drawn.inputs))]
    found = finished(outcomes(chosen, line_of, analysis))
    uncertainty_rows(found[:count], WINDS, asked)
    sensitivity_rows(drawn, found[:count], found[count:], analysis, asked)
    return time.process_time() - begin


if __name__ == "__main__":
    for name, value in samples():
        print(f"{name:24} {value:8.3f}", flush=True)
