"""The source's slips as theory section 9 settles them, and the statically divergent line of section 10."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from engine.mechanics.static_profile import static_profile
from engine.outcome import Outcome, Stability
from engine.spec import Analysis, Line, Span
from tests.builders import hybrid, run, source_line

E_MODULUS = 4.78033e10
TABLE_2_HYBRID_TORSION = {2: (0.635, 1.174, 1.737), 3: (0.555, 1.062, 1.581), 4: (0.553, 1.060, 1.578)}


def test_section_9_k_x_of_equal_adjacent_spans() -> None:
    profile = static_profile((source_line(2),))
    # (A10) by hand with L = L_x (1 + 8/3 (sag/L_x)^2); "1.285e5" is printed to four figures.
    weight, tension, rigidity, span = 2.379 * 9.81, 30e3, E_MODULUS * 594.48e-6, 125.88
    sag = weight * span**2 / (8.0 * tension)
    arc = span * (1.0 + 8.0 / 3.0 * (sag / span) ** 2)
    by_hand = 12.0 * rigidity * tension**3 / (12.0 * arc * tension**3 + rigidity * weight**2 * span**3)
    assert profile.end_stiffness[0] == pytest.approx([by_hand, by_hand], rel=1e-6)
    assert by_hand == pytest.approx(1.285e5, abs=50.0)


@pytest.mark.parametrize("subconductors", [2, 3, 4])
def test_section_9_area_of_the_iced_conductor_fits_table_2_and_the_bare_one_does_not(subconductors: int) -> None:
    line = source_line(subconductors)
    bare = replace(line, conductor=replace(line.conductor, axial_rigidity=E_MODULUS * 423.24e-6))
    fall = []
    for loops, printed in enumerate(TABLE_2_HYBRID_TORSION[subconductors], start=1):
        iced_torsion, bare_torsion = (torsional_frequency(x, loops) for x in (line, bare))
        assert iced_torsion == pytest.approx(printed, rel=0.006)
        fall.append(1.0 - bare_torsion / printed)
    assert [round(100.0 * f) in range(3, 8) for f in fall] == [True] * 3


def torsional_frequency(line: Line, loops: int) -> float:
    """Return the coupled frequency of the mode that is mostly torsional, from M and K of the hybrid model."""
    model = hybrid(line, loops)
    values, vectors = eigh(model.stiffness[0], model.mass[0])
    share = model.modal_masses[0][:, None] * vectors**2
    return float(np.sqrt(values[share[2].argmax()]) / (2.0 * math.pi))


def test_section_10_single_conductor_of_200_m_is_statically_divergent() -> None:
    line = replace(source_line(1), span=Span(200.0, horizontal_tension=30e3))
    result = run(line, Analysis(wind_speeds=(4.0, 6.0)))
    assert result.critical_wind_speeds == ()
    assert len(result.limit_cycles) == 2 * 2 * 2
    for row in result.limit_cycles:
        assert row.outcome is Outcome.STATICALLY_UNSTABLE
        assert row.kind == "equilibrium"
        assert row.stability is Stability.UNSTABLE
        assert row.vertical_m is row.horizontal_m is row.torsional_rad is row.frequency_hz is None
    one_loop = [row for row in result.frequencies if row.loops == 1]
    assert [(row.outcome, row.torsional_hz) for row in one_loop] == [(Outcome.STATICALLY_UNSTABLE, None)] * 2


def test_section_10_torsional_divergence_of_the_single_conductor_is_near_144_m() -> None:
    # GJ (pi/L)^2 = m g e_y: the torsional stiffness of a rod against the ice moment.
    by_hand = math.pi * math.sqrt(101.0 / (2.379 * 9.81 * 2.05e-3))
    assert by_hand == pytest.approx(144.0, abs=1.5)
    spans = [by_hand - 0.5, by_hand + 0.5]
    lines = [replace(source_line(1), span=Span(x, horizontal_tension=30e3)) for x in spans]
    # Sag lengthens the arc by 8/3 (sag/L_x)^2 = 1e-3 of the span, 0.1 m; half a metre brackets the divergence.
    assert [bool(hybrid(x).statically_unstable[0]) for x in lines] == [False, True]
