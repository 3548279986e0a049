"""Remedies in words: what is done, and what it does."""

from collections.abc import Mapping, Sequence
from typing import Any

from engine.result import Change, Result
from engine.spec import (
    AddedDevices,
    AddedSpoiler,
    ChangedTension,
    DetuningPendulum,
    InterphaseSpacer,
    PointDevice,
    Remedy,
    Spacer,
    TorsionalDamper,
)
from engine.studies.arrangements import Places
from engine.studies.judgement import LEAST

_NAMES: Mapping[type[PointDevice], str] = {
    DetuningPendulum: "detuning pendulum",
    Spacer: "spacer",
    TorsionalDamper: "torsional damper",
    InterphaseSpacer: "interphase spacer",
}
_HEADS: Mapping[Change, str] = {
    "better": "Better",
    "worse": "Worse than nothing",
    "no_improvement": "No improvement",
    "undecided": "Not decided",
}


def what_is_done(remedy: Remedy, places: Places | None, alone: Result, changed: Result) -> str:
    """Return what a remedy does to the line; without places a search found none."""
    where = "" if places is None else f", at {_listed([f'{place:g}' for place in places])} m"
    if isinstance(remedy, ChangedTension):
        before, after = alone.static.horizontal_tension_n, changed.static.horizontal_tension_n
        what = f"{remedy.factor:g} times the tension" if remedy.factor is not None else "Another tension"
        return f"{what}: {after:,.0f} N instead of {before:,.0f} N under ice"
    if isinstance(remedy, AddedSpoiler):
        middle = "" if places is None else f", its middle at {places[0]:g} m"
        return f"1 airflow spoiler of {remedy.length:g} m{middle}"
    if isinstance(remedy, AddedDevices):
        return f"{_counted(remedy.count, _NAMES[type(remedy.device)])}{_size(remedy.device)}{where}"
    count = len(places or ())
    return f"{_counted(count, _NAMES[remedy.moved]) if count else _NAMES[remedy.moved] + 's'} moved{where}"


def what_it_does(
    change: Change,
    before: Mapping[str, Any],
    own: Mapping[str, Any],
    shares: Mapping[str, float | None],
    arrangements: int | None,
) -> str:
    """Return the sentence of a row.

    Parameters
    ----------
    change : str
    before, own : mapping
        Figures of the row of the line as it is, and of this row.
    shares : mapping
        Of the samples.
    arrangements : int or None
        Those of a search without result.
    """
    if arrangements is not None:
        return f"No improvement found: none of {arrangements} arrangements is better than nothing; none is proposed."
    phrases = [_onset(before["onset_m_per_s"], own["onset_m_per_s"])] if change != "undecided" else []
    size = (before["motion_peak_to_peak_m"], own["motion_peak_to_peak_m"])
    if change == "undecided":
        unknown = "with the remedy" if own["gallops"] == "undecided" or size[1] is None else "without it"
        phrases.append(f"a figure of the line {unknown} is not known")
    elif None not in size:
        phrases.append(_motion(*size))
    near = (before["clearance_m"], own["clearance_m"])
    if change != "undecided" and None not in near and abs(near[1] - near[0]) > LEAST * abs(near[0]):
        phrases.append(f"the smallest clearance {_moved(*near)} m")
    return f"{_HEADS[change]}: {', '.join(phrases)}{_of_samples(shares)}."


def _onset(before: float | None, own: float | None) -> str:
    if own is None:
        return "no onset" if before is None else f"the onset at {before:.1f} m/s is gone"
    if before is None:
        return f"an onset appears at {own:.1f} m/s"
    return f"the onset {_moved(before, own)} m/s"


def _motion(before: float, own: float) -> str:
    if own == 0.0:
        return "at rest as before" if before == 0.0 else "at rest at the wind speeds asked for"
    return f"the largest motion {_moved(before, own)} m peak to peak"


def _moved(before: float, own: float) -> str:
    digits = 2 if max(before, own) < 10.0 else 1
    if abs(own - before) <= LEAST * before:
        return f"stays at {before:.{digits}f}"
    return f"{'rises' if own > before else 'falls'} from {before:.{digits}f} to {own:.{digits}f}"


def _of_samples(shares: Mapping[str, float | None]) -> str:
    if shares["improves"] is None:
        return ""
    better, worse = 100.0 * shares["improves"], 100.0 * (shares["worsens"] or 0.0)
    return f"; better in {better:.0f} % of the samples, worse in {worse:.0f} %"


def _size(device: PointDevice) -> str:
    arm = f", arm {device.arm:g} m" if isinstance(device, DetuningPendulum) else ""
    return f" of {device.mass:g} kg{arm}"


def _counted(count: int, name: str) -> str:
    return f"{count} {name}" if count == 1 else f"{count} {name}s"


def _listed(words: Sequence[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
