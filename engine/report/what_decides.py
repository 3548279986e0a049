"""Which assumed value decides, and its name in words."""

from collections.abc import Sequence

from engine.result import Result
from engine.result.uncertainty import SensitivityRow, UncertaintyRow
from engine.result.verdict import Gallops

LIKELY = 0.5  # probability from which samples bear out a yes
RARE = 0.05  # probability from which they contradict a no

_WORDS = {
    "ice.aerodynamics": "the ice shape",
    "ice.aerodynamics_at_rest": "the ice shape",
    "ice.aerodynamics.reference_diameter": "the reference diameter of the coefficients",
    "ice.accretion.angle": "the angle of the ice",
    "ice.accretion.density": "the density of the ice",
    "wind.air_density": "the density of the air",
    "damping.vertical_ratio": "the vertical damping",
    "damping.horizontal_ratio": "the horizontal damping",
    "damping.torsional_ratio": "the torsional damping",
    "conductor.bare_polar_inertia": "the polar inertia",
    "span.temperature": "the temperature of the iced span",
    "span.everyday.temperature": "the everyday temperature",
    "supports.left.adjacent_span": "the adjacent span on the left",
    "supports.right.adjacent_span": "the adjacent span on the right",
}


def overall(result: Result) -> UncertaintyRow | None:
    """Return the row about all wind speeds, None without samples."""
    return next((row for row in result.uncertainty if row.wind_speed_m_per_s is None), None)


def decides_how_far(row: UncertaintyRow) -> bool:
    """Whether all samples with an answer gallop, so that only the size of the motion is open."""
    return row.probability == 1.0


def what_decides(result: Result) -> str | None:
    """Return the path of the assumed value with the largest total index, None if the samples do not tell it.

    The index is that on the onset; on the amplitude where all samples gallop.
    """
    about = overall(result)
    if about is None:
        return None
    indices = _totals(result.sensitivities, amplitude=decides_how_far(about))
    return max(indices, key=indices.__getitem__, default=None)


def in_words(path: str) -> str:
    """Return what a field is, in words: the words for it or for what it belongs to, else its own name."""
    for known in (path, path.rsplit(".", 1)[0]):
        if known in _WORDS:
            return _WORDS[known]
    return f"the {path.rsplit('.', 1)[-1].replace('_', ' ')}"


def weighed(result: Result, gallops: Gallops, sentences: Sequence[str]) -> tuple[Gallops, str]:
    """Return the answer and its sentence with what the samples say.

    The answer for the values as assumed stands where the samples bear it out: a yes if half of them gallop or more, a
    no if less than one in twenty does.

    Parameters
    ----------
    result : Result
    gallops : {"yes", "no", "undecided"}
        The answer for the values as assumed.
    sentences : sequence of str
        What is to be said of them.
    """
    about, added = overall(result), _clause(result)
    if about is None or added is None:
        return gallops, " ".join(sentences)
    first, *others = sentences
    chance = about.probability
    contradicted = chance is not None and (
        (gallops == "yes" and chance < LIKELY) or (gallops == "no" and chance >= RARE)
    )
    if contradicted:
        first = f"Not decided. With all values as assumed: {first[0].lower()}{first[1:]}"
    sentence = " ".join([f"{first.removesuffix('.')}; {added}.", *others])
    return "undecided" if contradicted else gallops, sentence


def _clause(result: Result) -> str | None:
    """Return what the samples add to the sentence of a verdict, None without samples."""
    about = overall(result)
    if about is None:
        return None
    chance = "no sample tells the probability"
    if about.probability is not None:
        chance = f"probability {about.probability:.2g}"
    without = about.unknown + about.statically_unstable
    if without:
        chance += f" ({without} of {about.samples} samples have no answer)"
    path = what_decides(result)
    if path is None:
        return chance
    return f"{in_words(path)} decides{' how far' if decides_how_far(about) else ''}: {chance}"


def _totals(rows: Sequence[SensitivityRow], *, amplitude: bool) -> dict[str, float]:
    totals = {row.path: row.amplitude_total if amplitude else row.onset_total for row in rows}
    return {path: share for path, share in totals.items() if share is not None}
