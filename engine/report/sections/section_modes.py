"""The table of the natural modes of a section. Theory section 16."""

from collections.abc import Sequence

import numpy as np

from engine.assemblies.assembled_line import AssembledLine
from engine.assemblies.numbered_modes import NumberedModes, largest_member, member_shares
from engine.report.critical_wind_speeds import DIRECTION_NAMES
from engine.result import SectionModeRow
from engine.spec import Model


def share_text(shares: Sequence[float]) -> str:
    """Return the shares of all spans as text."""
    return " ".join(f"{share:.4f}" for share in shares)


def section_mode_rows(
    whole: AssembledLine, model: Model, modes: NumberedModes, numbers: Sequence[int]
) -> list[SectionModeRow]:
    """Return a row for the mode of each direction and number that the modes have, by direction and number."""
    chosen = np.flatnonzero((modes.direction >= 0) & np.isin(modes.number, numbers))
    chosen = chosen[np.lexsort((modes.number[chosen], modes.direction[chosen]))]
    shares = member_shares(whole.assembly, modes.displacement[chosen])
    largest = largest_member(shares) + 1
    with np.errstate(invalid="ignore"):
        frequency = np.sqrt(modes.squares[chosen]) / (2.0 * np.pi)
    return [
        SectionModeRow(
            model=model,
            direction=DIRECTION_NAMES[modes.direction[mode]],
            mode=int(modes.number[mode]),
            frequency_hz=float(frequency[i]) if np.isfinite(frequency[i]) else None,
            span=int(largest[i]),
            span_shares=share_text(shares[i].tolist()),
        )
        for i, mode in enumerate(chosen.tolist())
    ]
