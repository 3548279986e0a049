"""The remedies that are tried where none are named. Their masses, arms and dampings are assumed: no source has them."""

from collections.abc import Iterator, Sequence

from engine.outcome import InvalidSpec
from engine.spec import (
    THIS,
    AddedDevices,
    Analysis,
    ChangedTension,
    DetuningPendulum,
    InterphaseSpacer,
    Line,
    Model,
    MovedDevices,
    Remedies,
    Remedy,
    Spacer,
    TorsionalDamper,
    check_remedies,
)

PENDULUM = DetuningPendulum(0.0, 20.0, 0.4)  # assumed; 5 to 40 kg, 0.2 to 1 m
DAMPER = TorsionalDamper(0.0, 20.0, 0.8, 15.0)  # assumed; as the example of docs/devices.md
SPACER = Spacer(0.0, 6.5, 0.4)  # assumed; 3 to 15 kg
INTERPHASE_MASS = 30.0  # assumed; 15 to 100 kg
LOOSER, TIGHTER = 0.8, 1.2


def usual_remedies(line: Line, analysis: Analysis, separation: float | None) -> tuple[tuple[Remedy, ...], list[str]]:
    """Return the remedies that suit a line, and a sentence for each kind that is left out."""
    tried: list[Remedy] = []
    notes = ["Airflow spoilers were not tried: their coefficients must be given."]
    for remedy in _candidates(line):
        if remedy.kind == "interphase_spacer" and Model.FINITE_ELEMENT not in analysis.models:
            notes.append("Interphase spacers were not tried: they need finite_element in analysis.models.")
            continue
        try:
            check_remedies(line, analysis, Remedies((remedy,), separation))
        except InvalidSpec as error:
            notes.append(f"Not tried, {remedy.kind.replace('_', ' ')}: {error}.")
        else:
            tried.append(remedy)
    return tuple(tried), notes


def _candidates(line: Line) -> Iterator[Remedy]:
    yield AddedDevices(PENDULUM, 3)
    yield AddedDevices(DAMPER, 2)
    if any(isinstance(device, Spacer) for device in line.devices):
        yield MovedDevices(Spacer)
    elif len(line.bundle.positions) > 1:
        yield AddedDevices(SPACER, 4)
    yield from _between_phases(line)
    yield ChangedTension(LOOSER)
    yield ChangedTension(TIGHTER)


def _between_phases(line: Line) -> Sequence[Remedy]:
    if not line.phases or line.interphase_spacers:
        return []
    nearest = min(line.phases, key=lambda phase: phase.y**2 + phase.z**2)
    return [AddedDevices(InterphaseSpacer(0.0, INTERPHASE_MASS, (THIS, nearest.name)), 1)]
