"""Phases tied by spacers against OpenSees: chains of bars with truss bars between them."""

from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
import pytest

from engine.assemblies.assembly import natural_motions
from engine.assemblies.phases import assembled_phases
from engine.mechanics.finite_elements import U, V, W
from engine.spec import Ice, InterphaseSpacer, Line, Phase, Span, Support, Supports
from tests.builders import source_line

LENGTH, MODES = 125.88, 16


@dataclass(frozen=True, slots=True)
class Hung:
    """Tension [N], mass [kg/m] and place (y, z) [m] of a phase."""

    tension: float
    mass: float
    place: tuple[float, float]


SPAN = Hung(30e3, 2.379, (0.0, 0.0))
RIGID = InterphaseSpacer(62.94, 20.0, ("0", "1"))
CASES = {
    "above": ((SPAN, replace(SPAN, place=(7.0, 0.0))), (RIGID,)),
    "oblique, unequal": ((SPAN, Hung(27e3, 2.6, (5.0, 4.0))), (RIGID,)),
    "three, one elastic": (
        (SPAN, replace(SPAN, place=(5.0, 4.0)), replace(SPAN, place=(10.0, 0.0))),
        (replace(RIGID, axial_stiffness=2e3, mass=15.0), replace(RIGID, between=("1", "2"))),
    ),
}


def own_line(hung: Hung) -> Line:
    """Return a single conductor between dead ends whose ice is centred, as chains of bars are."""
    line, dead_end = source_line(1), Support(dead_end=True)
    return replace(
        line,
        conductor=replace(line.conductor, mass=hung.mass),
        ice=Ice(line.ice.aerodynamics),
        span=Span(LENGTH, horizontal_tension=hung.tension, elements=20),
        supports=Supports(left=dead_end, right=dead_end),
    )


@pytest.mark.parametrize("case", CASES)
def test_all_frequencies_agree_within_a_thousandth(peer: ModuleType, case: str) -> None:
    from benchmarks import opensees_phases as phases  # noqa: PLC0415 - it loads the outside code

    hung, spacers = CASES[case]
    others = tuple(Phase(str(i), *one.place, line=own_line(one)) for i, one in enumerate(hung) if i)
    named = tuple(replace(s, between=tuple("this" if n == "0" else n for n in s.between)) for s in spacers)  # type: ignore[arg-type]
    whole = assembled_phases(replace(own_line(hung[0]), phases=others, devices=named))
    squares, _ = natural_motions(whole.assembly, (U, V, W))
    rigidity = own_line(SPAN).conductor.axial_rigidity
    expected = phases.tied_frequencies(
        [phases.HungPhase(peer.Conductor(rigidity, one.mass, one.tension), one.place) for one in hung],
        peer.Section((LENGTH,)),
        [
            phases.Truss(
                s.position,
                (int(s.between[0]), int(s.between[1])),
                s.axial_stiffness or phases.NEARLY_RIGID,
                s.mass,
            )
            for s in spacers
        ],
        MODES,
    )
    assert np.sqrt(squares[:MODES]) / (2.0 * np.pi) == pytest.approx(expected, rel=1e-3)
