"""The effect of pendulums, placed by the search, on the source's lines."""

from collections.abc import Iterator

from benchmarks.lines import source_line
from benchmarks.validation.common import SUBCONDUCTORS, table
from engine.progress import finished
from engine.result import Result
from engine.spec import Analysis, Model, Objective, PendulumChoice, Placement
from engine.studies.placement import place

ASKED = Analysis(models=(Model.HYBRID,), wind_speeds=(4.0,))
CHOICE = PendulumChoice(2, (10.0, 115.0), (5.0, 20.0), (0.2, 0.5))


def section() -> Iterator[str]:
    """Yield the section's text."""
    yield "## Two pendulums placed by the search\n"
    yield (
        "The search places two equal pendulums of 5 to 20 kg on arms of 0.2 to 0.5 m between 10 and 115 m, either for "
        "the highest onset of one and two loops or for the lowest amplitude sqrt(V^2 + W^2) at 4 m/s. Onsets are in "
        "m/s and amplitudes in m, each without -> with the pendulums.\n"
    )
    head = ["n", "objective", "positions m", "mass kg", "arm m", "loops", "onset", "amplitude at 4 m/s"]
    yield table(head, [row for n in SUBCONDUCTORS for objective in Objective for row in _rows(n, objective)])


def _rows(subconductors: int, objective: Objective) -> Iterator[list[object]]:
    found = _placed(subconductors, objective)
    positions = ", ".join(f"{row.position_m:.1f}" for row in found.placements)
    first = found.placements[0]
    for effect in found.device_effects:
        onset = _pair(effect.critical_wind_speed_without_m_per_s, effect.critical_wind_speed_with_m_per_s)
        amplitude = _pair(effect.amplitude_without_m, effect.amplitude_with_m)
        words = objective.value.replace("_", " ")
        device = [positions, f"{first.mass_kg:.1f}", f"{first.arm_m:.2f}"]
        yield [subconductors, words, *device, effect.loops, onset, amplitude]


def _pair(without: float | None, fitted: float | None) -> str:
    return " -> ".join("none" if value is None else f"{value:.3f}" for value in (without, fitted))


def _placed(subconductors: int, objective: Objective) -> Result:
    return finished(
        place(source_line(subconductors), ASKED, Placement(CHOICE, objective, generations=12, population=16))
    )
