"""Everything that was found with one kind of model: what the tables of motions are written from."""

from dataclasses import dataclass

from engine.arrays import FloatArray, IntArray
from engine.checks.confidence import Confidence
from engine.cycles.bifurcations import Bifurcations
from engine.cycles.search import Cycles
from engine.models.critical_wind_speeds import Crossings
from engine.models.reduced_model import ReducedModel
from engine.spec import Model
from engine.tori.quasi_periodic import QuasiPeriodicMotions


@dataclass(frozen=True, slots=True)
class ModelFindings:
    """Critical wind speeds, motions and bifurcations of all members of a stack of models.

    model: leading axis (members,); line: (members,), index of each member's line; loops: (members, m), number of loops
    of each coordinate; winds: (winds,), wind speeds asked for in rising order [m/s].
    """

    name: Model
    model: ReducedModel
    line: IntArray
    loops: IntArray
    crossings: Crossings
    cycles: Cycles
    confidence: Confidence
    bifurcations: Bifurcations
    quasi_periodic: QuasiPeriodicMotions
    winds: FloatArray
