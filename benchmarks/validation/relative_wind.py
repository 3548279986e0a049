"""The effect of the relative wind (theory section 13), and its expansion compared with the exact load."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.lines import source_line
from benchmarks.models import discretized, first_antinode
from benchmarks.validation.common import SUBCONDUCTORS, WINDS, percent, result, table
from engine.arrays import FloatArray
from engine.cycles.harmonic_balance import Orbits, half_peak_to_peak, select, states
from engine.cycles.search import find_cycles
from engine.cycles.starts import explicit_starts
from engine.mechanics.modes import at_points, directional_shapes
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.discretization import Discretization
from engine.models.hybrid import hybrid_model, with_published_load
from engine.models.reduced_model import ReducedModel, take
from engine.result import LimitCycleRow
from engine.spec import AerodynamicModel, Analysis, Line, Model

DRAG_AT_REST = 1.0
OTHER_DRAGS = (0.5, 1.5)
CYCLES = 500
BLOCK = 20
STEPS = 64

Force = Callable[[FloatArray, FloatArray], FloatArray]


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Relative wind\n"
    yield (
        "In the source only the vertical velocity changes the relative wind. `aerodynamic_model: relative_wind` takes "
        "the whole velocity of each sub-conductor into account. It needs the coefficients at rest, which the source "
        f"does not print; a_z0 = {DRAG_AT_REST:g} (drag) and a_y0 = a_theta0 = 0 are assumed here. Hybrid model, "
        "stable cycles; in brackets the change against the published model in %.\n"
    )
    yield table(["n", "loops", "wind m/s", "vertical m", "horizontal m", "torsional rad"], list(_changes()))
    yield (
        "\nThe result depends on the assumed drag: the horizontal amplitude of the twin bundle in two loops at 6 m/s "
        "is "
        + ", ".join(f"{_horizontal(drag):.4f} m with a_z0 = {drag:g}" for drag in OTHER_DRAGS)
        + ".\n\nCritical wind speeds, m/s:\n"
    )
    yield table(["n", "loops", "published", "relative wind"], list(_onsets()))
    yield (
        "\nThe load is expanded to third order. To check the expansion, direct integration (DOP853, relative tolerance "
        f"1e-7) starts on each cycle and runs for {CYCLES:,} periods with the load as theory section 13 writes it, "
        "integrated along the span by quadrature at every step. The last column is the change of the largest amplitude "
        f"between the last two blocks of {BLOCK} periods.\n"
    )
    head = ["n", "loops", "wind m/s", "amplitude", "expanded", "not expanded", "difference %", "still moving %"]
    yield table(head, [row for n in (1, 2, 3) for row in unexpanded_rows(n)])


def _line(subconductors: int, drag: float = DRAG_AT_REST) -> Line:
    """Return a line of the source with coefficients at rest."""
    line = source_line(subconductors)
    aerodynamics = replace(line.ice.aerodynamics, at_rest=(0.0, drag, 0.0))
    return replace(line, ice=replace(line.ice, aerodynamics=aerodynamics))


def _asked(model: AerodynamicModel) -> Analysis:
    return Analysis(models=(Model.HYBRID,), wind_speeds=WINDS, aerodynamic_model=model)


def _changes() -> Iterator[list[object]]:
    for n in SUBCONDUCTORS:
        published, relative = (
            result(_line(n), _asked(model)) for model in (AerodynamicModel.PUBLISHED, AerodynamicModel.RELATIVE_WIND)
        )
        for loops in (1, 2):
            for wind in WINDS:
                before = _stable(published.limit_cycles, loops, wind)
                after = _stable(relative.limit_cycles, loops, wind)
                cells = [_changed(a, b) for a, b in zip(before, after, strict=True)] if after else ["no cycle"] * 3
                yield [n, loops, f"{wind:g}", *cells]


def _stable(rows: tuple[LimitCycleRow, ...], loops: int, wind: float) -> tuple[float, ...]:
    """Return the amplitudes of the stable cycle at a wind speed, none if there is none."""
    for row in rows:
        if (row.loops, row.wind_speed_m_per_s, row.kind, row.stability) == (loops, wind, "periodic", "stable"):
            return (row.vertical_m or 0.0, row.horizontal_m or 0.0, row.torsional_rad or 0.0)
    return ()


def _horizontal(drag: float) -> float:
    found = result(_line(2, drag), _asked(AerodynamicModel.RELATIVE_WIND))
    return _stable(found.limit_cycles, 2, 6.0)[1]


def _changed(before: float, after: float) -> str:
    return f"{after:.4f} ({percent(after, before)})"


def _onsets() -> Iterator[list[object]]:
    for n in SUBCONDUCTORS:
        found = [
            {row.loops: row.wind_speed_m_per_s for row in reversed(one.critical_wind_speeds)}
            for one in (
                result(_line(n), replace(_asked(model), wind_speeds=()))
                for model in (AerodynamicModel.PUBLISHED, AerodynamicModel.RELATIVE_WIND)
            )
        ]
        for loops in (1, 2):
            yield [n, loops, *(f"{one[loops]:.3f}" if loops in one else "none" for one in found)]


def unexpanded_rows(subconductors: int, cycles: int = CYCLES) -> Iterator[list[object]]:
    """Yield the amplitudes of the stable cycles of one line, and those of direct integration."""
    line = _line(subconductors)
    discretization = discretized((line,))
    analysis = _asked(AerodynamicModel.RELATIVE_WIND)
    shapes = directional_shapes(discretization.matrices, discretization.profile.arc_length, (1, 2))
    grid = hybrid_model(discretization, shapes, (1, 2), analysis)
    model, published = take(grid, 0), take(with_published_load(discretization, grid), 0)
    winds = np.array(WINDS)
    crossings = critical_wind_speeds(model, analysis.critical_wind_limit)
    starts = explicit_starts(published, model, winds, analysis.harmonics)
    found = find_cycles(model, crossings, winds, starts, analysis.harmonics)
    stable = np.flatnonzero(found.floquet.stability == "stable")
    orbits, member = select(found.orbits, stable), found.member[stable]
    settled, moved = settle(
        take(model, member), orbits, unexpanded(discretization, take(model, member), orbits.wind_speed), cycles
    )
    for i, loops in enumerate((member + 1).tolist()):
        seen = first_antinode(model.shapes[member[[i]]], loops)[0]
        before = half_peak_to_peak(seen.T @ orbits.coefficients[i])
        after = 0.5 * np.ptp(settled[i] @ seen, axis=0)
        largest = int(before[:2].argmax())
        amplitudes = f"{before[largest]:.4f}", f"{after[largest]:.4f}", percent(before[largest], after[largest])
        place = [subconductors, loops, f"{orbits.wind_speed[i]:g}", ("vertical m", "horizontal m")[largest]]
        yield [*place, *amplitudes, f"{100.0 * moved[i]:.3f}"]


def unexpanded(discretization: Discretization, model: ReducedModel, wind_speed: FloatArray) -> Force:
    """Return the generalized load of the relative wind, less its value at rest, by quadrature along the span.

    Parameters
    ----------
    discretization : Discretization
        Of one line whose coefficients are the same along the span, in uniform wind.
    model : ReducedModel
        Leading axis (cycles,).
    wind_speed : (cycles,)
        [m/s].

    Returns
    -------
    callable
        Of q and q', each (cycles, m); it returns (cycles, m) [N, N m].
    """
    line = discretization.lines[0]
    d, count = line.conductor.diameter, wind_speed.size
    fields = at_points(discretization.matrices, model.shapes).reshape(count, 3, 3, -1)
    weight = discretization.matrices.weight.reshape(-1)
    coefficients = discretization.sections.aerodynamics[0].reshape(weight.size, 3, 4)[0]
    strength = 0.5 * line.wind.air_density * d * wind_speed[:, None] ** 2 * weight

    def force(q: FloatArray, rate: FloatArray) -> FloatArray:
        turn = np.einsum("cm,cmp->cp", q, fields[:, :, 2])
        velocity = [np.einsum("cm,cmp->cp", rate, fields[:, :, i]) / wind_speed[:, None] for i in range(3)]
        loads = np.zeros((3, *turn.shape))
        for arm in line.bundle.positions:
            loads += _on_subconductor(coefficients, d, arm, [turn, *velocity])
            loads -= _on_subconductor(coefficients, d, arm, [np.zeros_like(turn)] * 4)
        return np.asarray(np.einsum("icp,cmip->cm", loads * strength, fields))

    return force


def _on_subconductor(
    coefficients: FloatArray, diameter: float, arm: tuple[float, float], motion: list[FloatArray]
) -> FloatArray:
    """Return vertical force, horizontal force and moment about the reference curve over 1/2 rho d U^2: (3, ...).

    coefficients: (3, 4); arm: (y_i, z_i) [m]; motion: Theta, V'/U, W'/U and Theta'/U [1/m].
    """
    turn, v, w, spin = motion
    y, z = arm
    rise, along = v - z * spin + 0.5 * diameter * spin, 1.0 - w - y * spin
    pressure = along**2 + rise**2
    angle = turn - np.arctan2(rise, along)
    c_y, c_z, c_theta = (np.polynomial.polynomial.polyval(angle, row) for row in coefficients)
    vertical = pressure * (c_y * np.cos(turn) - c_z * np.sin(turn))
    horizontal = pressure * (c_y * np.sin(turn) + c_z * np.cos(turn))
    return np.stack([vertical, horizontal, diameter * pressure * c_theta + y * horizontal - z * vertical])


def settle(model: ReducedModel, orbits: Orbits, force: Force, cycles: int) -> tuple[FloatArray, FloatArray]:
    """Integrate all cycles side by side, each in its own phase w t, and return the last block of each.

    Returns
    -------
    history : (cycles, samples, m)
        Coordinates over the last block.
    moved : (cycles,)
        Relative change of the largest amplitude between the last two blocks.
    """
    m = model.mass.shape[-1]
    inverse, frequency = np.linalg.inv(model.mass), orbits.angular_frequency[:, None]
    start = states(orbits, np.zeros(1))[:, 0]
    start[:, m:] *= orbits.wind_speed[:, None]

    def rate(_: float, flat: FloatArray) -> FloatArray:
        q, velocity = np.split(flat.reshape(-1, 2 * m), 2, axis=-1)
        load = force(q, velocity) - np.einsum("cij,cj->ci", model.stiffness, q)
        load = load - np.einsum("cij,cj->ci", model.damping, velocity)
        acceleration = np.einsum("cij,cj->ci", inverse, load)
        return np.asarray((np.concatenate([velocity, acceleration], axis=-1) / frequency).ravel())

    end = 2.0 * np.pi * cycles
    times = np.linspace(end - 2.0 * np.pi * 2 * BLOCK, end, 2 * BLOCK * STEPS + 1)
    done = solve_ivp(rate, (0.0, end), start.ravel(), method="DOP853", t_eval=times, rtol=1e-7, atol=1e-9)
    history = done.y.T.reshape(times.size, -1, 2 * m)[..., :m].swapaxes(0, 1)
    first, last = (
        np.ptp(history[:, part], axis=1) for part in (slice(None, BLOCK * STEPS), slice(BLOCK * STEPS, None))
    )
    change = np.abs(last / first - 1.0)
    return history[:, BLOCK * STEPS :], np.take_along_axis(change, last.argmax(axis=-1)[:, None], axis=-1)[:, 0]
