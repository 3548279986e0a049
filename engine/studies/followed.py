"""A study over one field with its cycles joined to branches over the field, and their bifurcations."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import BoolArray, FloatArray, IntArray, take_rows
from engine.cycles.harmonic_balance import Orbits, half_peak_to_peak, select, states
from engine.cycles.known_cycles import Starts, solve_starts
from engine.cycles.resolution import resolved_stability
from engine.mechanics.modes import directional_shapes
from engine.mechanics.static_profile import arc_position, horizontal_position
from engine.models.discretization import Discretization, discretize, shapes_at
from engine.models.hybrid import hybrid_model
from engine.models.reduced_model import ReducedModel, take
from engine.outcome import Fault, require
from engine.report.cells import finite_or_none
from engine.report.observers.widest_places import widest_places
from engine.result import FollowedBifurcationRow, FollowedCycleRow, Result
from engine.spec import Analysis, Line, Model
from engine.studies.field_branches import FieldCycles, FieldProblem, follow_over_field
from engine.studies.field_models import field_models

PHASES = 2.0 * np.pi * np.arange(24) / 24  # at which the widest place is sought
MORE_HARMONICS = 4  # added to those asked for: near a fold truncation shifts the field's value more than the amplitude

LineAt = Callable[[float], Line]


def followed(line_at: LineAt, values: Sequence[float], results: Sequence[Result], analysis: Analysis) -> list[Result]:
    """Follow the hybrid model's cycles over a field, at every number of loops and wind speed of an analysis.

    Parameters
    ----------
    line_at : callable
        Returns the line at a value of the field; a branch ends where it raises ValueError or ArithmeticError.
    values : sequence of float
        At least two, in rising order.
    results : sequence of Result
        Of the lines at these values with this analysis.
    analysis : Analysis

    Returns
    -------
    list of Result
        The results with `followed_cycles`, and with `followed_bifurcations` at the nearest value.

    Raises
    ------
    InvalidSpec
        If the load is not expanded: models at values in between are interpolated, which needs polynomials.
    """
    rule = "must be expanded, and the model no table, in a study that follows its cycles"
    require(Fault("aerodynamic_load", analysis.aerodynamic_load.value, rule) if analysis.load_stands else None)
    rule = "must be given where cycles are followed over a field"
    moving = any(line_at(value).follows_wind for value in values)
    require(Fault("wind.blow_out.wind_speed", None, rule) if moving else None)
    rule = "must be absent where cycles are followed over a field"
    several = any(line_at(value).section is not None for value in values)
    require(Fault("section", None, rule) if several else None)
    study = _Study(line_at, np.array(values, dtype=np.float64), analysis)
    discretization, grid = study.models_of([line_at(value) for value in values])
    known = study.starts(discretization, grid, results)
    if known.member.size == 0:
        return list(results)
    problem = study.problem(grid)
    found = follow_over_field(problem, study.values, known)
    cycles = _cycle_rows(study, discretization, grid, found)
    turns = _bifurcation_rows(study, found)
    return [
        replace(result, followed_cycles=tuple(own), followed_bifurcations=tuple(turned))
        for result, own, turned in zip(results, cycles, turns, strict=True)
    ]


@dataclass(frozen=True, slots=True)
class _Study:
    """A line over a field; the members are its numbers of loops, each at every wind speed."""

    line_at: LineAt
    values: FloatArray
    analysis: Analysis

    @property
    def winds(self) -> FloatArray:
        return np.array(sorted(set(self.analysis.wind_speeds)))

    @property
    def column(self) -> IntArray:
        """Index of the number of loops of each member."""
        return np.repeat(np.arange(len(self.analysis.loops)), self.winds.size)

    def models_of(self, lines: Sequence[Line]) -> tuple[Discretization, ReducedModel]:
        """Return the hybrid models (lines, loops) as an analysis builds them."""
        discretization = discretize(lines, self.analysis.static_twist)
        loops = tuple(sorted({*self.analysis.loops, 1, 2}))
        shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, loops)
        return discretization, hybrid_model(discretization, shapes, self.analysis.loops, self.analysis)

    def models_at(self, values: FloatArray) -> ReducedModel | None:
        """Return the models at values, leading axes (values, loops); None if one of them has no line."""
        try:
            return self.models_of([self.line_at(value) for value in values.tolist()])[1]
        except (ValueError, ArithmeticError):
            return None

    def problem(self, grid: ReducedModel) -> FieldProblem:
        """Return the equations; sizes are measured with the model in the middle of the range."""
        members, column = self.column.size, self.column
        models = field_models(self.models_at, float(self.values[0]), float(self.values[-1]))

        def models_of_members(values: FloatArray, member: IntArray) -> tuple[ReducedModel, BoolArray]:
            return models.at(values, column[member])

        return FieldProblem(
            model=take(grid, (self.values.size // 2, self.column)),
            member=np.arange(members),
            reference=np.ones(members),
            models_at=models_of_members,
            wind_speed=np.tile(self.winds, len(self.analysis.loops)),
            width=float(np.ptp(self.values)),
        )

    def starts(self, discretization: Discretization, grid: ReducedModel, results: Sequence[Result]) -> Starts:
        """Return the cycles of the hybrid model, read back from results."""
        size = 2 * (self.analysis.harmonics + MORE_HARMONICS) + 1
        member, value, rate, coefficients = [], [], [], []
        for i, result in enumerate(results):
            for orbit in result.orbits:
                row = result.limit_cycles[orbit.cycle]
                if row.model is not Model.HYBRID or row.kind != "periodic" or row.frequency_hz is None:
                    continue
                column = self.analysis.loops.index(row.loops)
                arc = arc_position(discretization.profile, np.full(len(results), row.observed_at_m))[i]
                share = arc / discretization.profile.arc_length[[i]]
                seen = shapes_at(grid.shapes[[i], column], share)[0]
                observed = np.array([orbit.vertical, orbit.horizontal, orbit.torsional])[:, :size]
                series = np.linalg.pinv(seen.T) @ observed
                coefficients.append(np.pad(series, ((0, 0), (0, size - series.shape[1]))))
                member.append(column * self.winds.size + int(np.searchsorted(self.winds, row.wind_speed_m_per_s)))
                value.append(i)
                rate.append(2.0 * np.pi * row.frequency_hz)
        places = np.array(member, dtype=np.intp)
        wind = np.tile(self.winds, len(self.analysis.loops))[places]
        orbits = Orbits(np.array(coefficients).reshape(-1, 3, size), np.array(rate), wind)
        return self.balanced(grid, Starts(places, np.array(value, dtype=np.intp), orbits))

    def balanced(self, grid: ReducedModel, starts: Starts) -> Starts:
        """Solve for the cycles with the number of harmonics used here; return those that converged."""
        models = take(grid, (starts.wind, self.column[starts.member]))
        solved, good = solve_starts(models, Starts(np.arange(starts.wind.size), starts.wind, starts.orbits))
        return Starts(starts.member[good], starts.wind[good], select(solved.orbits, np.flatnonzero(good)))


def _cycle_rows(
    study: _Study, discretization: Discretization, grid: ReducedModel, found: FieldCycles
) -> list[list[FollowedCycleRow]]:
    rows: list[list[FollowedCycleRow]] = [[] for _ in study.values]
    column = study.column[found.member]
    models = take(grid, (found.value, column))
    orbits, judged, kept, _ = resolved_stability(models, np.arange(column.size), found.orbits)
    loops_of = np.array(study.analysis.loops)[column]
    coordinate = np.asarray((models.modal_masses * (orbits.coefficients[..., 1:] ** 2).sum(axis=-1)).argmax(axis=-1))
    displacement = states(orbits, PHASES)[..., : models.mass.shape[-1]]
    seen = widest_places(models.shapes, models.direction[coordinate], loops_of, coordinate, displacement)
    amplitudes = half_peak_to_peak(seen.shapes.swapaxes(-1, -2) @ orbits.coefficients)
    profile = take_rows(discretization.profile, found.value)
    position = horizontal_position(profile, profile.arc_length * seen.share)
    for i in np.flatnonzero(kept).tolist():
        loops, value = int(loops_of[i]), int(found.value[i])
        vertical, horizontal, torsional = amplitudes[i].tolist()
        row = FollowedCycleRow(
            loops=loops,
            wind_speed_m_per_s=float(orbits.wind_speed[i]),
            branch=int(found.branch[i]),
            stability=judged.stability[i],
            frequency_hz=float(orbits.angular_frequency[i] / (2.0 * np.pi)),
            observed_at_m=float(position[i]),
            vertical_m=vertical,
            horizontal_m=horizontal,
            torsional_rad=torsional,
            found_by="point" if found.given[i] else "field_branch",
        )
        rows[value].append(row)
    return rows


def _bifurcation_rows(study: _Study, found: FieldCycles) -> list[list[FollowedBifurcationRow]]:
    rows: list[list[FollowedBifurcationRow]] = [[] for _ in study.values]
    b = found.bifurcations
    for i in range(b.member.size):
        row = FollowedBifurcationRow(
            loops=study.analysis.loops[study.column[b.member[i]]],
            wind_speed_m_per_s=float(np.tile(study.winds, len(study.analysis.loops))[b.member[i]]),
            branch=int(b.branch[i]),
            type=b.kind[i].value,
            value=float(b.parameter[i]),
            frequency_hz=float(b.angular_frequency[i] / (2.0 * np.pi)),
            second_frequency_hz=finite_or_none(float(b.second_frequency[i] / (2.0 * np.pi))),
            uncertainty=float(b.uncertainty[i]),
        )
        rows[int(np.abs(study.values - b.parameter[i]).argmin())].append(row)
    return rows
