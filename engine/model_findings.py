"""All motions of a stack of models: from a reduced model with its critical wind speeds to its findings."""

from dataclasses import dataclass
from functools import partial

from engine.arrays import FloatArray, IntArray
from engine.checks.bounded_motions import bounded_motions
from engine.checks.confidence import confidence
from engine.checks.direct_starts import direct_starts
from engine.cycles.bifurcations import bifurcations
from engine.cycles.known_cycles import Starts
from engine.cycles.search import DirectIntegration, find_cycles
from engine.models.critical_wind_speeds import Crossings, no_crossings
from engine.models.reduced_model import ReducedModel, of_each_member
from engine.report.findings import ModelFindings
from engine.spec import Analysis, Check, Model
from engine.tori.quasi_periodic import check_by_integration, quasi_periodic_motions


@dataclass(frozen=True, slots=True)
class ModelStack:
    """A stack of models before its motions are searched; fields as in ModelFindings."""

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings


def findings_of(stack: ModelStack, winds: FloatArray, starts: Starts, analysis: Analysis) -> ModelFindings:
    """Find all motions of a stack of models at wind speeds, and check them by direct integration if asked for.

    winds: of all members, (winds,), or of each, (members, winds), in rising order [m/s].
    """
    model, direct = stack.model, analysis.check is Check.DIRECT
    integration = DirectIntegration(
        starts=direct_starts(model, winds, analysis.harmonics) if direct else None,
        settle=partial(bounded_motions, model, winds, analysis.harmonics) if analysis.settle else None,
    )
    cycles = find_cycles(model, stack.crossings, winds, starts, analysis.harmonics, integration)
    bifurcation_points = bifurcations(cycles.branch_sets, cycles.followed, model, stack.crossings)
    tori = quasi_periodic_motions(model, cycles, bifurcation_points, winds, analysis.quasi_periodic)
    follows = analysis.follows_twist and winds.size  # crossings about this state hold at its wind speed only
    return ModelFindings(
        name=stack.name,
        model=model,
        line=stack.line,
        loops=stack.loops,
        crossings=no_crossings() if follows else stack.crossings,
        cycles=cycles,
        confidence=confidence(model, cycles, analysis.check),
        bifurcations=bifurcation_points,
        quasi_periodic=check_by_integration(model, tori) if direct else tori,
        winds=of_each_member(model, winds),
    )
