"""Hanging conductors in OpenSees, an independent code: chains of corotational bars with lumped masses."""

import itertools
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
import openseespy.opensees as ops

from benchmarks.free_vibration import mean_frequency
from engine.arrays import FloatArray

GRAVITY = 9.81
_DIRECTIONS = ("longitudinal", "vertical", "horizontal")


@dataclass(frozen=True, slots=True)
class Conductor:
    """One iced sub-conductor: axial rigidity EA [N], mass per length [kg/m], horizontal tension in still air [N].

    drag: mean drag per length [N/m].
    """

    axial_rigidity: float
    mass: float
    horizontal_tension: float
    drag: float = 0.0


@dataclass(frozen=True, slots=True)
class InsulatorString:
    """A suspension string that swings along and across the line: length [m] and weight a sub-conductor [N]."""

    length: float
    weight: float


@dataclass(frozen=True, slots=True)
class Section:
    """Spans between two ends that hold the conductor, with a string at every support between them. Theory section 16.

    spans: lengths [m]; level_difference: of each span, right end higher [m]; end_stiffness: of the left and the right
    end along the line [N/m], infinite at a dead end.
    """

    spans: tuple[float, ...]
    strings: tuple[InsulatorString, ...] = ()
    level_difference: float = 0.0
    end_stiffness: tuple[float, float] = (math.inf, math.inf)


@dataclass(frozen=True, slots=True)
class Mode:
    """A natural mode: frequency [Hz], direction of largest energy, shape (nodes, 3) in X, Y, Z."""

    frequency: float
    direction: str
    shape: FloatArray


@dataclass(frozen=True, slots=True)
class Node:
    """A node of a chain: its tag and place in X, Y and Z [m]."""

    tag: int
    x: float
    y: float
    z: float = 0.0


def natural_modes(conductor: Conductor, section: Section, count: int, bars: int = 160) -> tuple[FloatArray, list[Mode]]:
    """Compute the lowest modes of a section about its static state.

    Parameters
    ----------
    conductor : Conductor
    section : Section
    count : int
        Number of modes.
    bars : int
        Bars per span; the error of the frequencies falls with the square of the bar length.

    Returns
    -------
    positions : (nodes,) horizontal distance from the left end [m]
    modes : list of Mode
        In rising order of frequency.

    Raises
    ------
    RuntimeError
        If OpenSees finds no equilibrium.
    """
    with empty_model():
        nodes = chain(conductor, section, bars)
        _equilibrium(conductor, section, nodes)
        eigenvalues = ops.eigen(count)
        shapes = [np.array([ops.nodeEigenvector(node.tag, i + 1) for node in nodes]) for i in range(count)]
    modes = [
        Mode(math.sqrt(value) / (2.0 * math.pi), _DIRECTIONS[int((shape**2).sum(axis=0).argmax())], shape)
        for value, shape in zip(eigenvalues, shapes, strict=True)
    ]
    return np.array([node.x for node in nodes]), modes


def tension_in_wind(conductor: Conductor, section: Section, bars: int = 160) -> float:
    """Return the horizontal tension along the line under weight and mean drag [N]."""
    with empty_model():
        _equilibrium(conductor, section, chain(conductor, section, bars))
        return abs(float(ops.eleForce(1)[0]))


def vertical_frequency(conductor: Conductor, section: Section, loops: int, count: int = 12) -> float:
    """Return the frequency [Hz] of the mode whose vertical part is nearest to sin(loops pi x/L) of a single span."""
    positions, modes = natural_modes(conductor, section, count)
    sine = np.sin(loops * math.pi * positions / section.spans[0])
    return max(modes, key=lambda mode: abs(mode.shape[:, 1] @ sine) / np.linalg.norm(mode.shape)).frequency


def twin_torsional_frequency(conductor: Conductor, section: Section, loops: int, tied: str, bars: int = 160) -> float:
    """Return the frequency [Hz] of a horizontal twin bundle's torsional mode that is nearest to sin(loops pi x/L).

    Two chains side by side move across the line together. Their vertical motions stand for V and Theta: in a torsional
    mode they are opposite. Bars have no torsional rigidity and no polar inertia, so the spacing does not matter.

    Parameters
    ----------
    conductor : Conductor
    section : Section
        A single span.
    loops : int
    tied : str
        Where both chains also move along the line together: `everywhere`, as in a rigid section, `at ends`, as between
        held yokes, or `nowhere`.
    bars : int
        Bars per span.
    """
    with empty_model():
        one = chain(conductor, section, bars)
        other = chain(conductor, section, bars, first=len(one) + 1)
        ends = {one[0]: section.end_stiffness[0], one[-1]: section.end_stiffness[1]}
        for left, right in zip(one, other, strict=True):
            along = tied == "everywhere" or (tied == "at ends" and left in ends)
            directions = [1] * (along and ends.get(left, 0.0) < math.inf) + [3] * (left not in ends)
            if directions:
                ops.equalDOF(left.tag, right.tag, *directions)
        _equilibrium(conductor, section, one, other)
        eigenvalues = ops.eigen(8 * loops)
        tags = [[node.tag for node in nodes] for nodes in (one, other)]
        shapes = [[[ops.nodeEigenvector(tag, i + 1) for tag in row] for row in tags] for i in range(8 * loops)]
    sine = np.sin(loops * math.pi * np.array([node.x for node in one]) / section.spans[0])
    motion = np.array(shapes)  # (modes, chains, nodes, directions)
    opposite = (motion[:, 0, :, 1] - motion[:, 1, :, 1]) @ sine / np.sqrt((motion**2).sum(axis=(1, 2, 3)))
    return math.sqrt(eigenvalues[int(np.abs(opposite).argmax())]) / (2.0 * math.pi)


@contextmanager
def empty_model() -> Iterator[None]:
    """Open an empty model; OpenSees keeps one per process, so it is wiped before and after."""
    ops.wipe()
    ops.model("basic", "-ndm", 3, "-ndf", 3)
    try:
        yield
    finally:
        ops.wipe()


def chain(
    conductor: Conductor, section: Section, bars: int, first: int = 1, place: tuple[float, float] = (0.0, 0.0)
) -> list[Node]:
    """Place bars along the catenaries, each with its local tension; tags of nodes and bars begin with `first`.

    place: (y, z) of the left end [m].
    """
    y, z = place
    nodes = [Node(first, 0.0, y, z)]
    ops.node(first, 0.0, y, z)
    for length in section.spans:
        start = nodes[-1]
        for x, y in _catenary(conductor, length, section.level_difference, bars):
            node = Node(first + len(nodes), start.x + x, start.y + y, z)
            ops.node(node.tag, node.x, node.y, z)
            _bar(conductor, nodes[-1], node)
            nodes.append(node)
    return nodes


def _catenary(conductor: Conductor, length: float, rise: float, bars: int) -> list[tuple[float, float]]:
    """Return points at equal arc lengths on a catenary through (0, 0) and (length, rise), without the first."""
    c = conductor.horizontal_tension / (conductor.mass * GRAVITY)
    low = 0.5 * length - c * math.asinh(rise / (2.0 * c * math.sinh(length / (2.0 * c))))
    start, stop = math.sinh(-low / c), math.sinh((length - low) / c)
    x = low + c * np.arcsinh(np.linspace(start, stop, bars + 1)[1:])
    y = c * (np.cosh((x - low) / c) - math.cosh(low / c))
    return list(zip(x.tolist(), y.tolist(), strict=True))


def _bar(conductor: Conductor, left: Node, right: Node) -> None:
    tension = conductor.horizontal_tension * math.dist((left.x, left.y), (right.x, right.y)) / (right.x - left.x)
    elastic, stressed = 2 * left.tag, 2 * left.tag + 1
    ops.uniaxialMaterial("Elastic", elastic, conductor.axial_rigidity)
    ops.uniaxialMaterial("InitStressMaterial", stressed, elastic, tension)
    ops.element("corotTruss", left.tag, left.tag, right.tag, 1.0, stressed)


def _equilibrium(conductor: Conductor, section: Section, *chains: Sequence[Node]) -> None:
    """Support and load each chain, and solve for static equilibrium."""
    springs = Springs(sum(map(len, chains)))
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    for nodes in chains:
        support_and_load(conductor, section, nodes, springs)
    find_equilibrium()


def support_and_load(conductor: Conductor, section: Section, nodes: Sequence[Node], springs: "Springs") -> None:
    """Fix the supports of a chain, and apply mass and weight at its nodes."""
    lengths = [math.dist((a.x, a.y), (b.x, b.y)) for a, b in itertools.pairwise(nodes)]
    shares = 0.5 * (np.array([0.0, *lengths]) + np.array([*lengths, 0.0]))
    push = dict.fromkeys((node.tag for node in nodes), 0.0)
    for node, stiffness, sign in zip((nodes[0], nodes[-1]), section.end_stiffness, (-1.0, 1.0), strict=True):
        if math.isinf(stiffness):
            ops.fix(node.tag, 1, 1, 1)
        else:
            ops.fix(node.tag, 0, 1, 1)
            springs.hold(node, {1: stiffness})
            push[node.tag] = sign * conductor.horizontal_tension
    hung = {node.tag: 0.0 for node in nodes}
    every = (len(nodes) - 1) // len(section.spans)
    for i, string in enumerate(section.strings, start=1):
        node = nodes[i * every]
        carried = conductor.mass * GRAVITY * sum(lengths[(i - 1) * every : (i + 1) * every]) / 2.0
        stiffness = (carried + string.weight / 2.0) / string.length
        ops.fix(node.tag, 0, 1, 0)
        springs.hold(node, {1: stiffness, 3: stiffness})
        hung[node.tag] = string.weight / (3.0 * GRAVITY)  # a rigid rod's mass at its lower end
    for node, share in zip(nodes, shares.tolist(), strict=True):
        ops.mass(node.tag, *[conductor.mass * share + hung[node.tag]] * 3)
        ops.load(node.tag, push[node.tag], -conductor.mass * GRAVITY * share, conductor.drag * share)


class Springs:
    """Springs to fixed ground, with tags after those of nodes and bars."""

    def __init__(self, nodes: int) -> None:
        """Begin after the tags of this many nodes."""
        self._last = 4 * nodes

    def hold(self, node: Node, stiffness: dict[int, float]) -> None:
        """Connect a node to the ground by springs [N/m] in these directions (1 along, 3 across the line)."""
        ground = self._last = self._last + 1
        ops.node(ground, node.x, node.y, node.z)
        ops.fix(ground, 1, 1, 1)
        materials = []
        for value in stiffness.values():
            self._last += 1
            ops.uniaxialMaterial("Elastic", self._last, value)
            materials.append(self._last)
        self._last += 1
        ops.element("zeroLength", self._last, ground, node.tag, "-mat", *materials, "-dir", *stiffness)


def find_equilibrium() -> None:
    """Solve for static equilibrium under the loads.

    Raises
    ------
    RuntimeError
        If OpenSees finds none.
    """
    ops.system("BandGeneral")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.test("NormDispIncr", 1e-11, 50)
    ops.algorithm("Newton")
    ops.integrator("LoadControl", 0.0)
    ops.analysis("Static")
    if ops.analyze(1) != 0:
        raise RuntimeError("OpenSees found no equilibrium of the chain")


def swinging_frequency(
    conductor: Conductor, section: Section, loops: int, amplitude: float, periods: int = 24
) -> float:
    """Return the mean frequency [Hz] of a single span released from a horizontal sine of some loops.

    Parameters
    ----------
    conductor : Conductor
    section : Section
        Of one span.
    loops : int
    amplitude : float
        Of the displacement from which it is released [m].
    periods : int
        Number of periods that are counted, by the zero crossings of the first loop's middle.

    Raises
    ------
    RuntimeError
        If OpenSees finds no equilibrium at some instant.
    """
    with empty_model():
        nodes = chain(conductor, section, 24 * loops)
        _equilibrium(conductor, section, nodes)
        _release(conductor, section, nodes, (0.0, amplitude), loops)
        return _swinging(conductor, section, loops, periods, {nodes[12].tag: (3, 1.0)})


def twin_swinging_frequency(
    conductor: Conductor, section: Section, loops: int, amplitude: float, periods: int = 24
) -> float:
    """Return the same of a horizontal twin whose chains are released from opposite vertical sines, as torsion is.

    The chains move across the line together, but along it each by itself.
    """
    with empty_model():
        one = chain(conductor, section, 24 * loops)
        other = chain(conductor, section, 24 * loops, first=len(one) + 1)
        for left, right in zip(one[1:-1], other[1:-1], strict=True):
            ops.equalDOF(left.tag, right.tag, 3)
        _equilibrium(conductor, section, one, other)
        _release(conductor, section, one, (amplitude, 0.0), loops)
        _release(conductor, section, other, (-amplitude, 0.0), loops)
        return _swinging(conductor, section, loops, periods, {one[12].tag: (2, 1.0), other[12].tag: (2, -1.0)})


def _release(
    conductor: Conductor, section: Section, nodes: Sequence[Node], amplitude: tuple[float, float], loops: int
) -> None:
    """Displace a chain up and out by sines of some loops, evenly strained: else longitudinal waves would run for ever.

    A bar of extent (dx, dy) gets longer by (dx dU + dy dV + (dV^2 + dW^2)/2)/ds, and N ds/dx stretches it by
    N ds^2/(EA dx).
    """
    x, y = np.array([(node.x, node.y) for node in nodes]).T
    sine = np.sin(loops * math.pi * x / section.spans[0])
    up, out = amplitude[0] * sine, amplitude[1] * sine
    dx, dy, give = np.diff(x), np.diff(y), 1.0 / np.array(section.end_stiffness)
    own = (dy * np.diff(up) + 0.5 * (np.diff(up) ** 2 + np.diff(out) ** 2)) / dx
    bars = np.hypot(dx, dy) ** 3 / dx**2 / conductor.axial_rigidity
    tension = own.sum() / (bars.sum() + give.sum())
    along = tension * give[0] + np.append(0.0, np.cumsum(tension * bars - own))
    for node, *displacement in zip(nodes, along.tolist(), up.tolist(), out.tolist(), strict=True):
        for direction, value in enumerate(displacement, start=1):
            ops.setNodeDisp(node.tag, direction, ops.nodeDisp(node.tag, direction) + value, "-commit")


def _swinging(
    conductor: Conductor, section: Section, loops: int, periods: int, watched: dict[int, tuple[int, float]]
) -> float:
    """Integrate from the displaced state and return the mean frequency [Hz] of displacements of nodes, weighted."""
    steps = 240
    natural = 0.5 * loops / section.spans[0] * math.sqrt(conductor.horizontal_tension / conductor.mass)
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()
    ops.system("BandGeneral")
    ops.numberer("RCM")
    ops.constraints("Plain")
    ops.test("NormDispIncr", 1e-9, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    series = []
    for _ in range(periods * steps + steps):
        if ops.analyze(1, 1.0 / (natural * steps)) != 0:
            raise RuntimeError("OpenSees lost the chain's equilibrium while it swings")
        series.append(sum(weight * ops.nodeDisp(tag, direction) for tag, (direction, weight) in watched.items()))
    return mean_frequency(np.array(series), natural * steps)
