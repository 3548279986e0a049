"""The frequency of large free vibrations against exact chains of bars. Theory section 12.1."""

from types import ModuleType

import pytest

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
from engine.spec import CrossSection


@pytest.mark.parametrize(("name", "amplitude", "exact"), EXACT_SHIFTS[:-1])
def test_the_relief_coordinate_gives_the_shift_of_an_exact_chain(name: str, amplitude: float, exact: float) -> None:
    assert 100.0 * hybrid_shift(SPANS[name], amplitude) == pytest.approx(exact, rel=0.015)


def test_long_spans_between_dead_ends_relieve_in_more_shapes_than_one() -> None:
    name, amplitude, exact = EXACT_SHIFTS[-1]
    shifts = [100.0 * shift(SPANS[name], amplitude) for shift in (hybrid_shift, finite_element_shift)]
    assert shifts[0] == pytest.approx(exact, rel=0.05)
    assert shifts[1] == pytest.approx(exact, rel=0.005)


def test_a_large_motion_of_such_a_span_beats_as_in_the_exact_chain() -> None:
    name, amplitude, exact = BEATING
    hybrid, finite_element = (100.0 * shift for shift in swinging_shifts(SPANS[name], amplitude))
    assert finite_element == pytest.approx(exact, rel=0.05)
    assert hybrid == pytest.approx(exact, rel=0.4)  # one coordinate for the relief: see the warning


def test_the_finite_element_model_relieves_in_its_symmetric_modes() -> None:
    name, amplitude, exact = EXACT_SHIFTS[1]
    assert 100.0 * finite_element_shift(SPANS[name], amplitude) == pytest.approx(exact, rel=0.015)


def test_opensees_swings_at_the_same_frequency(peer: ModuleType) -> None:
    line = SPANS["source's line, springs"]
    conductor = peer.Conductor(line.conductor.axial_rigidity, line.conductor.mass, 30e3)
    section = peer.Section((125.88,), end_stiffness=(1.285e5, 1.285e5))
    small, large = (peer.swinging_frequency(conductor, section, 2, size) for size in (1e-3, 0.95))
    assert hybrid_shift(line, 0.95) == pytest.approx(large / small - 1.0, rel=0.02)


@pytest.mark.parametrize(("loops", "amplitude"), [(1, 0.95), (2, 0.36)])
def test_two_chains_of_opensees_twist_at_the_frequency_of_free_sections(
    peer: ModuleType, loops: int, amplitude: float
) -> None:
    conductor = twin(CrossSection.FREE).conductor
    chain = peer.Conductor(conductor.axial_rigidity, conductor.mass, 30e3), peer.Section((125.88,)), loops
    small, large = (peer.twin_swinging_frequency(*chain, size, periods=4) for size in (SMALL, amplitude))
    lines = twin(CrossSection.FREE), twin(CrossSection.RIGID)
    free, rigid = (released_shift(line, loops, amplitude, periods=4) for line in lines)
    assert free == pytest.approx(large / small - 1.0, rel=0.03)
    assert abs(rigid - free) > 0.1 * abs(free)
