"""Starts from direct integration, for cycles that neither branches nor formulas lead to. Theory section 7.5.

Each model is integrated from a few large starts at a few wind speeds until its motion has settled, or for two thousand
periods at most: Newton's method only needs a start near a cycle.
"""

import numpy as np

from engine.arrays import FloatArray, IntArray
from engine.checks.settled_motion import (
    BLOCK_PERIODS,
    SettledMotions,
    integrate_until_settled,
    lawson_equations,
    lawson_step,
    natural_frequency_range,
)
from engine.cycles.harmonic_balance import Orbits, fourier
from engine.cycles.known_cycles import Starts
from engine.models.reduced_model import ReducedModel, of_each_member
from engine.outcome import Outcome

WINDS = 3  # the lowest, the highest and one between them
LEVELS = (0.3, 0.8, 1.5)  # rad of torsion, or of the change of wind direction by vertical motion
HORIZONTAL = 2.0  # times the vertical amplitude: horizontal motion alone does not change the wind direction
PERIODS = 2000  # of the lowest natural frequency, after which a motion is used as it is
STEPS = 8  # in the shortest natural period: the linear part is exact, and a start need not be accurate
SAMPLED = 8  # longest natural periods to which a Fourier series is fitted
LARGEST_RATIO = 30.0  # of natural frequencies: stiffer models are integrated for fewer long periods, to bound the work
TOGETHER = 512  # starts integrated side by side, to bound the memory


def spread_starts(
    model: ReducedModel,
    member: IntArray,
    wind_speed: FloatArray,
    levels: tuple[float, ...],
    generator: np.random.Generator,
    *,
    alike: bool = False,
) -> FloatArray:
    """Draw random starts of several sizes, directions and phases.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    member, wind_speed : (cases,)
    levels : tuple of float
        Sizes: rad of torsion, or of the change of wind direction by vertical motion.
    generator : numpy.random.Generator
        Source of the phases and of the division of mixed starts between the coordinates.
    alike : bool
        Draw once for all cases, so that the starts of a case do not depend on which others are beside it.

    Returns
    -------
    (cases, levels (m + 1), 2 m)
        q and q': for each level one start per coordinate and one in which all move.
    """
    m = model.mass.shape[-1]
    largest, rate = _largest_amplitudes(model, member, wind_speed)
    shares = np.tile(np.concatenate([np.eye(m), np.zeros((1, m))]), (len(levels), 1))
    shares = np.tile(shares, (1 if alike else member.size, 1, 1))
    shares[:, m :: m + 1] = np.sqrt(generator.dirichlet(np.ones(m), (shares.shape[0], len(levels))))
    phase = generator.uniform(0.0, 2.0 * np.pi, shares.shape)
    # Give every coordinate at least a thousandth, so that no start lies in an invariant subspace.
    amplitude = np.repeat(levels, m + 1)[:, None] * np.maximum(shares, 1e-3) * largest[:, None]
    return np.concatenate([amplitude * np.cos(phase), -rate[:, None] * amplitude * np.sin(phase)], axis=-1)


def _largest_amplitudes(model: ReducedModel, member: IntArray, wind_speed: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return each coordinate's amplitude in a start of level 1 and natural frequency [rad/s]: (cases, m) each."""
    rate = np.sqrt(model.uncoupled_squares[member])
    form = np.abs(model.load.angle[member]).max(axis=1)
    vertical, horizontal, torsional = (np.flatnonzero(model.direction == d) for d in range(3))
    largest = np.empty_like(rate)
    windward = vertical[: horizontal.size]
    largest[:, windward] = wind_speed[:, None] / (rate[:, windward] * form[:, rate.shape[1] + windward])
    # The wind does not act on a relief coordinate, which follows the others: it starts with the first one's size.
    largest[:, vertical[horizontal.size :]] = largest[:, windward[:1]]
    largest[:, horizontal] = HORIZONTAL * largest[:, windward]
    largest[:, torsional] = 1.0 / form[:, torsional]
    return largest, rate


def direct_starts(model: ReducedModel, wind_speeds: FloatArray, harmonics: int) -> Starts:
    """Return starts of cycles read from the motions that large starts settle on at a few wind speeds.

    Parameters
    ----------
    model : ReducedModel
        Leading axis (members,).
    wind_speeds : (winds,) or (members, winds)
        [m/s].
    harmonics : int

    Returns
    -------
    Starts
        Of the motions that neither came to rest nor diverged. They are approximate, and several may lead to one cycle.
    """
    usable = np.flatnonzero(~model.statically_unstable)
    winds = of_each_member(model, wind_speeds)
    count = winds.shape[-1]
    chosen = np.unique(np.linspace(0, count - 1, WINDS).round().astype(np.intp))[:count]
    member, wind = np.repeat(usable, chosen.size), np.tile(chosen, usable.size)
    state = spread_starts(model, member, winds[member, wind], LEVELS, np.random.default_rng(0), alike=True)
    per_case = state.shape[1]
    member, wind, state = np.repeat(member, per_case), np.repeat(wind, per_case), state.reshape(-1, state.shape[-1])
    index, orbits = settled_cycles(model, member, winds[member, wind], state, harmonics)
    return Starts(member[index], wind[index], orbits)


def settled_cycles(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, start: FloatArray, harmonics: int
) -> tuple[IntArray, Orbits]:
    """Integrate starts (starts, 2 m) of members at wind speeds (starts,).

    Returns
    -------
    (cycles,), Orbits
        Indices of the starts that keep moving, and the cycles fitted to their motions.
    """
    groups = np.array_split(np.arange(member.size), -(-member.size // TOGETHER) or 1)
    parts = [_settled_group(model, member[i], wind_speed[i], start[i], harmonics) for i in groups]
    index = np.concatenate([group[kept] for group, (kept, _) in zip(groups, parts, strict=True)])
    names = ("coefficients", "angular_frequency", "wind_speed")
    return index, Orbits(*(np.concatenate([getattr(cycles, name) for _, cycles in parts]) for name in names))


def _settled_group(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, start: FloatArray, harmonics: int
) -> tuple[IntArray, Orbits]:
    runs = integrated_to_limit(model, member, wind_speed, start)
    kept = np.flatnonzero(~runs.at_rest & (runs.outcome != Outcome.NO_CONVERGENCE))
    moving, orbits = fitted_cycles(model, member[kept], wind_speed[kept], runs.state[kept], harmonics)
    return kept[moving], orbits


def fitted_cycles(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, start: FloatArray, harmonics: int
) -> tuple[IntArray, Orbits]:
    """Fit Fourier series to a few periods from states (starts, 2 m) on motions that have settled, or nearly.

    Returns
    -------
    (cycles,), Orbits
        Indices of the states whose motion is periodic enough, and the cycles.
    """
    ratio, _ = _lengths(model, member)
    equations = lawson_equations(model, member, wind_speed, STEPS)
    state, history = start.T, []
    weight = np.sqrt(model.modal_masses)[member]
    with np.errstate(over="ignore", invalid="ignore"):  # a motion may diverge here as well; no cycle is fitted then
        for _ in range(int(np.ceil(SAMPLED * STEPS * ratio.max(initial=0.0)))):
            state = lawson_step(equations, state)
            history.append(state[: model.mass.shape[-1]])
        series = np.stack(history, axis=-1) if history else np.zeros((weight.shape[1], 0, 1))
        fitted = [
            _fitted_cycle(series[:, i], weight[i], float(equations.step[i]), harmonics) for i in range(member.size)
        ]
    moving = np.array([i for i, cycles in enumerate(fitted) if cycles is not None], dtype=np.intp)
    cycles = [item for item in fitted if item is not None]
    shape = (len(cycles), weight.shape[1], 2 * harmonics + 1)
    coefficients = np.array([item[0] for item in cycles]).reshape(shape)
    return moving, Orbits(coefficients, np.array([item[1] for item in cycles]), wind_speed[moving])


def integrated_to_limit(
    model: ReducedModel, member: IntArray, wind_speed: FloatArray, start: FloatArray
) -> SettledMotions:
    """Integrate starts as `settled_cycles` does, and return what they settled on."""
    return integrate_until_settled(model, member, wind_speed, start, _lengths(model, member)[1], STEPS)


def _lengths(model: ReducedModel, member: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the bounded ratio of the natural frequencies of members (starts,), and the most blocks of each."""
    slowest, fastest = natural_frequency_range(model, member)
    ratio = np.minimum(fastest / slowest, LARGEST_RATIO)
    return ratio, np.ceil(PERIODS * ratio / BLOCK_PERIODS).astype(np.intp)


def _fitted_cycle(
    series: FloatArray, weight: FloatArray, step: float, harmonics: int
) -> tuple[FloatArray, float] | None:
    """Fit a Fourier series to samples (m, samples); return coefficients and angular frequency, None if aperiodic.

    The frequency is that of the upward crossings of the mean by the coordinate that moves most.
    """
    swing = series - series.mean(axis=-1, keepdims=True)
    main = swing[int((weight * swing.std(axis=-1)).argmax())]
    upward = np.flatnonzero((main[:-1] < 0.0) & (main[1:] >= 0.0))
    if upward.size < 2:
        return None
    crossing = upward + main[upward] / (main[upward] - main[upward + 1])
    frequency = 2.0 * np.pi * (upward.size - 1) / float(crossing[-1] - crossing[0])
    values = fourier(frequency * np.arange(main.size), harmonics)
    coefficients, *_ = np.linalg.lstsq(values, series.T, rcond=None)
    return np.asarray(coefficients.T, dtype=np.float64), frequency / step
