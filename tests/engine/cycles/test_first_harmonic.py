"""Explicit first harmonics: gains, energy, and what an oscillating wind's work must be."""

from dataclasses import replace

import numpy as np
import pytest

from engine.cycles.first_harmonic import energy_balance_cycles, explicit_cycles, stiffened_frequencies
from engine.models.aerodynamic_load import force
from engine.models.critical_wind_speeds import critical_wind_speeds
from engine.models.reduced_model import ReducedModel, take
from engine.models.stretching import restoring_force
from engine.spec import Analysis, Stretching
from tests.builders import Oscillators, finite_element, hand_made, hybrid, published, random_line, source_line


def first_harmonics(model: ReducedModel, wind_speed: float) -> list[tuple[float, float]]:
    """Return for each explicit cycle the errors of its mean and first-harmonic equations, relative to elastic force."""
    found = explicit_cycles(model, np.array([wind_speed]))
    one = take(model, 0)
    tau = 2.0 * np.pi * np.arange(32) / 32.0
    result = []
    for omega, mean, amplitude in zip(found.angular_frequency, found.mean, found.amplitude, strict=True):
        q = mean + (amplitude[None] * np.exp(1j * tau)[:, None]).real
        velocity = (1j * omega * amplitude[None] * np.exp(1j * tau)[:, None]).real
        load = wind_speed**2 * force(one.load, np.concatenate([q, velocity / wind_speed], axis=-1))
        dynamic = one.stiffness - omega**2 * one.mass + 1j * omega * one.damping
        elastic = np.abs(one.stiffness @ amplitude).max()
        first = dynamic @ amplitude - 2.0 * (load * np.exp(-1j * tau)[:, None]).mean(axis=0)
        still = one.stiffness @ mean - load.mean(axis=0)
        result.append((float(np.abs(first).max() / elastic), float(np.abs(still).max() / elastic)))
    return result


@pytest.mark.parametrize("subconductors", [1, 2, 3])
@pytest.mark.parametrize("loops", [1, 2])
@pytest.mark.parametrize("wind_speed", [3.0, 6.0])
def test_explicit_cycles_meet_the_mean_and_first_harmonic_of_the_equations(
    subconductors: int, loops: int, wind_speed: float
) -> None:
    model = published(source_line(subconductors), loops)
    found = first_harmonics(model, wind_speed)
    assert found
    # The cubic of a mean and one harmonic is exact in 32 samples; what remains is the root, found to 1e-5. A wrong gain
    # would leave the wind's work, which is of the order of the damping ratio: 5e-4.
    assert np.max(found) < 5e-5


def test_explicit_angle_is_the_amplitude_of_its_scalar() -> None:
    model = published(source_line(3), 1)
    found = explicit_cycles(model, np.array([5.0]))
    form = model.load.forms[0, 0, 0]
    scalar = found.amplitude @ form[:3] + (1j * found.angular_frequency / 5.0)[:, None] * found.amplitude @ form[3:]
    assert np.abs(scalar) == pytest.approx(found.angle, rel=5e-5)


def test_explicit_cycle_is_born_at_the_critical_speed() -> None:
    model = published(source_line(2), 1)
    (critical,) = critical_wind_speeds(model, 5.0).wind_speed
    speeds = critical * np.array([0.999, 1.001, 1.004, 1.009])
    found = explicit_cycles(model, speeds)
    assert found.wind.tolist() == [1, 2, 3]
    # Amplitude grows with the root of the distance: 1, 2, 3 for 1, 4, 9 thousandths.
    size = np.abs(found.amplitude[:, 0])
    assert size[1:] / size[0] == pytest.approx([2.0, 3.0], rel=0.01)


def test_stack_gives_what_each_member_gives() -> None:
    models = [published(random_line(np.random.default_rng(seed)), 1) for seed in (3, 4)]
    for model in models:
        stack = replace(take(model, [0, 0]), damping=np.array([[[1.0]], [[2.0]]]) * model.damping)
        speeds = np.array([[4.0, 8.0, 9.0], [5.0, 6.0, 7.0]])
        together = explicit_cycles(stack, speeds)
        places = [(i, j) for i in range(2) for j in range(3)]
        alone = [explicit_cycles(take(stack, [i]), speeds[i, j : j + 1]) for i, j in places]
        expected = [place for place, one in zip(places, alone, strict=True) for _ in one.member]
        assert list(zip(together.member.tolist(), together.wind.tolist(), strict=True)) == expected
        assert together.angle == pytest.approx(np.concatenate([a.angle for a in alone]), rel=1e-6)


def test_stretching_raises_the_frequency_by_the_quotient_of_means_over_a_period() -> None:
    model = hybrid(source_line(2), 2, Analysis(stretching=Stretching.INCLUDED))
    assert model.stretching is not None
    draw, member = np.random.default_rng(1), np.zeros(5, dtype=np.intp)
    amplitude = draw.normal(size=(5, model.mass.shape[-1])) + 1j * draw.normal(size=(5, model.mass.shape[-1]))
    found = stiffened_frequencies(model, member, np.full(5, 3.0), amplitude)
    q = (amplitude[:, None] * np.exp(2j * np.pi * np.arange(64) / 64.0)[:, None]).real
    work, inertia = ((part * q).sum(axis=(1, 2)) for part in (restoring_force(model.stretching, q), q @ model.mass[0]))
    assert found == pytest.approx(np.sqrt(9.0 + work / inertia), rel=1e-12)
    assert found.min() > 3.0


def test_energy_balance_is_exact_for_a_cubic_damper() -> None:
    # c q' against U (a q' - b q'^3 / U^2): R^2 w^2 = 4 U^2 (U a - c) / (3 U b).
    c, a, b, omega, speed = 0.1, 0.05, 0.4, 3.0, 7.0
    model = hand_made(
        Oscillators(np.eye(2), np.diag([c, 0.5]), np.diag([omega**2, 30.0]), {(0, (2,)): a, (0, (2, 2, 2)): -b})
    )
    found = energy_balance_cycles(model, np.array([speed]))
    expected = speed / omega * np.sqrt(4.0 * (speed * a - c) / (3.0 * speed * b))
    sizes = np.sort(np.abs(found.amplitude[:, 0]))
    # The frequency is that of the growing mode: off by (U a - c)^2/(8 w^2) = 1e-3.
    assert np.abs(sizes / expected - 1.0).min() < 2e-3
    assert found.angular_frequency == pytest.approx(np.full(found.member.size, omega), rel=2e-3)


@pytest.mark.parametrize("subconductors", [1, 2])
def test_energy_balance_gives_nothing_below_the_critical_speed(subconductors: int) -> None:
    model = hybrid(source_line(subconductors), 1)
    assert energy_balance_cycles(model, np.array([2.39])).member.size == 0
    assert energy_balance_cycles(model, np.array([2.41])).member.size > 0


def test_energy_balance_guesses_one_cycle_or_more_for_every_unstable_mode_of_the_full_model() -> None:
    model = finite_element(source_line(2))
    found = energy_balance_cycles(model, np.array([6.0]))
    frequencies = np.unique(np.round(found.angular_frequency / (2.0 * np.pi), 2))
    assert frequencies == pytest.approx([0.48, 0.89, 1.34], abs=0.011)  # Table 2: one, two and three loops
