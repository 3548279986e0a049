"""Models and motions that tests of several modules look at."""

from dataclasses import replace
from functools import cache

import numpy as np

from engine.arrays import FloatArray
from engine.cycles.bifurcations import Bifurcations, bifurcations
from engine.cycles.first_harmonic import energy_balance_cycles
from engine.cycles.harmonic_balance import (
    Orbits,
    balance,
    resized,
)
from engine.cycles.search import Cycles, find_cycles
from engine.cycles.starts import energy_starts
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.spec import AerodynamicLoad, AerodynamicModel, Analysis, CrossSection, Line, Span, Stretching
from tests.builders import finite_element, hybrid, source_line
from tests.engine.synthetic_table import with_table

LIGHT = 0.0308


WINDS = np.array([4.0, 8.0, 12.0])


@cache
def analysed(subconductors: int, torsional_ratio: float, loops: int) -> tuple[ReducedModel, Cycles, Bifurcations]:
    model = take(hybrid(source_line(subconductors, torsional_ratio=torsional_ratio), loops), [0])
    crossings = critical_wind_speeds(model, 30.0)
    cycles = find_cycles(model, crossings, WINDS, energy_starts(model, WINDS, 5), 5)
    return model, cycles, bifurcations(cycles.branch_sets, cycles.followed, model, crossings)


def resonant_line() -> Line:
    """Return a line whose fifth harmonic meets the torsional mode near 7.7 m/s (two loops)."""
    line = source_line(1, torsional_ratio=0.006463488305849856)
    return replace(line, span=Span(115.59664153237746, horizontal_tension=27144.507347366452))


def bifurcations_between(
    line: Line, loops: int, winds: FloatArray, analysis: Analysis | None = None
) -> tuple[Cycles, Bifurcations]:
    """Return the cycles of a hybrid model at wind speeds, and the bifurcations on their branches."""
    model = hybrid(line, loops, analysis)
    crossings = critical_wind_speeds(model, 30.0)
    cycles = find_cycles(model, crossings, winds, energy_starts(model, winds, 5), 5)
    return cycles, bifurcations(cycles.branch_sets, cycles.followed, model, crossings)


RELATIVE = Analysis(aerodynamic_model=AerodynamicModel.RELATIVE_WIND)
STRETCHING = Analysis(stretching=Stretching.INCLUDED)


def relative_line(subconductors: int) -> Line:
    """Return a source line whose ice has coefficients at rest."""
    line = source_line(subconductors)
    aerodynamics = replace(line.ice.aerodynamics, at_rest=(0.05, 1.0, 0.02))
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


def free_sections(line: Line) -> Line:
    """Return a line whose sub-conductors move along the span by themselves."""
    return replace(line, bundle=replace(line.bundle, section=CrossSection.FREE))


UNEXPANDED = replace(RELATIVE, aerodynamic_load=AerodynamicLoad.UNEXPANDED)
TABLE = Analysis(aerodynamic_model=AerodynamicModel.TABLE, stretching=Stretching.INCLUDED)


def short(line: Line) -> Line:
    """Return a line of four elements, for loads that are integrated along the span at every state."""
    return replace(line, span=replace(line.span, elements=4))


MODELS = {
    "hybrid, unexpanded": lambda: hybrid(short(relative_line(2)), 2, UNEXPANDED),
    "hybrid, table and stretching": lambda: hybrid(short(with_table(source_line(2), 20.0)), 2, TABLE),
    "finite element, table": lambda: finite_element(short(with_table(source_line(1), -20.0)), (1, 2), TABLE),
    "hybrid": lambda: hybrid(source_line(3), 2),
    "hybrid, relative wind": lambda: hybrid(relative_line(2), 2, RELATIVE),
    "hybrid, stretching": lambda: hybrid(relative_line(2), 2, STRETCHING),
    "one loop, stretching": lambda: hybrid(relative_line(3), 1, STRETCHING),
    "free sections, stretching": lambda: hybrid(free_sections(relative_line(2)), 1, STRETCHING),
    "finite element, stretching": lambda: finite_element(source_line(2), (1, 2), STRETCHING),
    "finite element": lambda: finite_element(source_line(2)),
    "finite element, relative wind": lambda: finite_element(relative_line(1), (1, 2), RELATIVE),
}


def random_orbits(model: ReducedModel, harmonics: int, copies: int) -> Orbits:
    """Return large arbitrary motions, so that the cubic terms matter."""
    rng = np.random.default_rng(harmonics)
    m = model.mass.shape[-1]
    scale = 0.3 / np.sqrt(model.modal_masses[0])
    coefficients = scale[:, None] * rng.normal(size=(copies, m, 2 * harmonics + 1))
    return Orbits(coefficients, rng.uniform(2.0, 6.0, copies), rng.uniform(3.0, 9.0, copies))


COPIES = 11  # not a multiple of what the kernels do side by side


def perturbed(model: ReducedModel) -> ReducedModel:
    """Return a stack of models, each with a damping of its own, so that members must not be mixed up."""
    stack = take(model, np.zeros(4, dtype=np.intp))
    factors = np.linspace(0.5, 2.0, 4)[:, None, None]
    return replace(stack, damping=factors * stack.damping)


def orbit_of(model: ReducedModel, wind_speed: float) -> Orbits:
    """Return the first cycle that the energy balance leads to, with twelve harmonics."""
    guess = energy_balance_cycles(model, np.array([wind_speed]))
    first = np.stack([guess.mean, guess.amplitude.real, -guess.amplitude.imag], axis=-1)
    start = Orbits(first, guess.angular_frequency, np.full(guess.member.size, wind_speed))
    orbits, solution = balance(model, np.zeros(guess.member.size, dtype=np.intp), resized(start, 12))
    i = int(np.flatnonzero(solution.converged)[0])
    return Orbits(orbits.coefficients[[i]], orbits.angular_frequency[[i]], orbits.wind_speed[[i]])
