"""Large free vibrations beside exact chains of bars: frequency, and energy and tensions of free sections.

Theory sections 12.1 and 12.2.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from benchmarks.bundle_chain import stretched
from benchmarks.free_vibration import (
    BEATING,
    EXACT_SHIFTS,
    SMALL,
    SPANS,
    finite_element_shift,
    hybrid_shift,
    released_shift,
    swinging_shifts,
    twin,
)
from benchmarks.lines import source_line
from benchmarks.models import discretized
from benchmarks.opensees import Conductor, Section, twin_swinging_frequency
from benchmarks.validation.common import percent, table
from engine.arrays import FloatArray
from engine.models.stretching import dynamic_tension, restoring_force, stretching_of, take_stretching
from engine.spec import CrossSection, Line, Support, Supports, Yoke

BARS, ELEMENTS = 100, 20
MOTIONS = (  # amplitudes of V, W [m] and Theta [rad] in one loop, then in two
    (0.6, 0.3, 0.3, 0.2, 0.2, -0.2),
    (0.2, 0.1, 0.1, 0.05, 0.05, -0.1),
)
RELEASED, PERIODS = (0.2, 0.36, 0.95), 8


def section() -> Iterator[str]:
    """Yield the section's text."""
    rows = []
    for name, amplitude, exact in EXACT_SHIFTS:
        found = [100.0 * shift(SPANS[name], amplitude) for shift in (hybrid_shift, finite_element_shift)]
        rows.append([name, amplitude, f"{exact:.3f}", *(f"{value:.3f}" for value in found)])
    name, amplitude, exact = BEATING
    found = [100.0 * shift for shift in swinging_shifts(SPANS[name], amplitude)]
    rows.append([f"{name}, released", amplitude, f"{exact:.3f}", *(f"{value:.3f}" for value in found)])
    yield "## Stretching\n"
    yield (
        "Shift of the frequency of two horizontal loops, in percent, when they swing freely with an amplitude A: an\n"
        "exact chain of bars (theory section 12.1), the hybrid model with its relief coordinate, and the finite\n"
        "element model with the modes of 1, 2, 3 and 5 loops. Long spans between dead ends give way in\n"
        "more shapes than one: there the hybrid model is some 4 % off in the shift, and a quarter at 2 m, where the\n"
        "motion beats. In that row the spans are released, and the frequency is the mean over 24 periods.\n"
    )
    yield table(["span", "A m", "exact %", "hybrid %", "finite element %"], rows)
    yield (
        "\nA twin between dead ends in free torsional vibration, released from a sine of Theta in which the\n"
        "sub-conductors are A above and below their places: shift of the frequency over\n"
        f"{PERIODS} periods, in percent. OpenSees has two chains of bars, released evenly strained, which move across\n"
        "the line together and along it each by itself. The finite element model, with free and with rigid sections,\n"
        "holds the modes of 1, 2, 3 and 5 loops.\n"
    )
    yield table(["loops", "A m", "OpenSees %", "free %", "rigid %"], list(_beside_opensees()))
    yield (
        "\nFree sections (theory section 12.2): a bundle between dead ends is moved across the line, in one and in\n"
        "two loops together, by V and W in m and Theta in rad. P is the energy beyond that of the linear stiffness,\n"
        "N_i what each sub-conductor's horizontal tension gains. The chains of bars (benchmarks/bundle_chain.py) have\n"
        "exact lengths; their joints find their places along the line by least energy, each sub-conductor by itself.\n"
    )
    head = ["n", "yokes", "V W Theta, one loop", "two loops", "P, J", "chains", "%", "N_i, N", "chains"]
    yield table(head, [row for n in (2, 3, 4) for yoke in Yoke for row in _beside_chains(n, yoke)])


def _beside_opensees() -> Iterator[list[object]]:
    conductor = source_line(2).conductor
    peer, span = Conductor(conductor.axial_rigidity, conductor.mass, 30e3), Section((125.88,))
    for loops in (1, 2):
        small = twin_swinging_frequency(peer, span, loops, SMALL, PERIODS)
        for amplitude in RELEASED:
            expected = twin_swinging_frequency(peer, span, loops, amplitude, PERIODS) / small - 1.0
            lines = twin(CrossSection.FREE), twin(CrossSection.RIGID)
            own = (released_shift(line, loops, amplitude, PERIODS) for line in lines)
            yield [loops, amplitude, *(f"{100.0 * shift:.3f}" for shift in (expected, *own))]


def _beside_chains(subconductors: int, yoke: Yoke) -> Iterator[list[object]]:
    end = Support(dead_end=True, yoke=yoke)
    line = source_line(subconductors)
    bundle = replace(line.bundle, section=CrossSection.FREE)
    span = replace(line.span, elements=ELEMENTS)
    line = replace(line, bundle=bundle, span=span, supports=Supports(left=end, right=end))
    for motion in MOTIONS:
        amplitudes = np.array(motion)
        (own, own_tension), (chain, chain_tension) = _own(line, amplitudes), _chains(line, amplitudes)
        cells = [" ".join(f"{x:g}" for x in part) for part in (motion[:3], motion[3:])]
        tensions = [" ".join(f"{x:.0f}" for x in part) for part in (own_tension, chain_tension)]
        energies = f"{own:.4g}", f"{chain:.4g}", percent(own, chain)
        yield [subconductors, yoke, *cells, *energies, *tensions]


def _waves(places: int) -> FloatArray:
    """Return V, W and Theta of each amplitude of a motion: (6, 3, places)."""
    sines = np.sin(np.pi * np.outer((1, 2), np.linspace(0.0, 1.0, places)))
    return np.asarray(np.einsum("kp,df->kdfp", sines, np.eye(3)).reshape(6, 3, places))


def _own(line: Line, amplitudes: FloatArray) -> tuple[float, FloatArray]:
    """Return P [J] and N_i [N]; P from its derivative, whose parts are of degree two and three."""
    stretching = take_stretching(
        stretching_of(discretized([line]), _waves(2 * line.span.elements + 1)[None, None]), (0, 0)
    )
    assert stretching is not None
    forward, backward = (restoring_force(stretching, sign * amplitudes[None])[0] for sign in (1.0, -1.0))
    energy = amplitudes @ ((forward + backward) / 6.0 + (forward - backward) / 8.0)
    return float(energy), dynamic_tension(stretching, amplitudes[None])[0]


def _chains(line: Line, amplitudes: FloatArray) -> tuple[float, FloatArray]:
    """Return the same of chains of bars; the quadratic part of their energy is that of small motion."""
    motion = np.tensordot(amplitudes, _waves(BARS + 1), axes=1).T
    tied = "at ends" if line.supports.left.yoke is Yoke.HELD else "nowhere"
    ends = (np.inf, np.inf)
    large, *small = (stretched(line, ends, scale * motion, tied) for scale in (1.0, SMALL, -SMALL))
    return large.energy - 0.5 * sum(x.energy for x in small) / SMALL**2, large.tension
