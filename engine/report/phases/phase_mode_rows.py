"""The table of the natural modes of tied phases, and the frequencies of the lowest ones."""

import numpy as np

from engine.arrays import IntArray
from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.numbered_modes import NumberedModes, largest_member, member_shares
from engine.assemblies.phase_modes import loops_of_modes, relative_motion
from engine.assemblies.phases import tied_places
from engine.outcome import Outcome
from engine.report.critical_wind_speeds import DIRECTION_NAMES
from engine.result import FrequencyRow, PhaseModeRow
from engine.spec import Analysis, Model


def phase_mode_rows(whole: AssembledLine, modes: NumberedModes, chosen: IntArray) -> list[PhaseModeRow]:
    """Return a row for each of the chosen modes, in their order."""
    names = list(tied_places(whole.line))
    shares = member_shares(whole.assembly, modes.displacement[chosen])
    largest, loops = largest_member(shares), loops_of_modes(whole, modes, chosen)
    motion = relative_motion(whole, modes, chosen)
    return [
        PhaseModeRow(
            model=Model.FINITE_ELEMENT,
            direction=DIRECTION_NAMES[modes.direction[mode]],
            mode=int(modes.number[mode]),
            loops=int(loops[i]),
            frequency_hz=_frequency(float(modes.squares[mode])),
            phase=names[largest[i]],
            phase_shares=" ".join(f"{share:.4f}" for share in shares[i].tolist()),
            phase_motion=" ".join(f"{share + 0.0:.3f}" for share in (motion[i].round(3) + 0.0).tolist()),
        )
        for i, mode in enumerate(chosen.tolist())
    ]


def lowest_frequencies(rows: list[PhaseModeRow], analysis: Analysis) -> tuple[FrequencyRow, ...]:
    """Return the lowest frequency of each direction and number of loops asked for, from the rows of the modes."""
    found = []
    for k in sorted(analysis.loops):
        own = [[row.frequency_hz for row in rows if (row.direction, row.loops) == (d, k)] for d in DIRECTION_NAMES]
        lowest = [None if not values or None in values else min(v for v in values if v) for values in own]
        unstable = any(None in values for values in own)
        outcome = Outcome.STATICALLY_UNSTABLE if unstable else Outcome.CONVERGED
        found.append(FrequencyRow(Model.FINITE_ELEMENT, k, lowest[0], lowest[1], lowest[2], outcome))
    return tuple(found)


def _frequency(square: float) -> float | None:
    return float(np.sqrt(square) / (2.0 * np.pi)) if square > 0.0 else None
