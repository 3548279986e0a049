"""The verdict on a line: does it gallop, from which wind, how far, and how well is that known?"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from engine.clearance import EllipseMethod, galloping_ellipse
from engine.outcome import Outcome, Stability
from engine.report.what_decides import overall, weighed, what_decides
from engine.result import LimitCycleRow, PhaseClearanceRow, Result, TensionRow, VerdictRow
from engine.result.verdict import Gallops, Trust
from engine.spec import Analysis, Check, Line

AGREEMENT = 0.01  # largest relative change under direct integration of a cycle that counts as checked
_BEYOND = {Outcome.OUTSIDE_FIT, Outcome.BEYOND_DATA, Outcome.NO_BOUNDED_MOTION, Outcome.STATICALLY_UNSTABLE}


@dataclass(frozen=True, slots=True)
class _Evidence:
    """What a result says about galloping.

    moving: stable motions, the largest vertical amplitude first; unknown: rows without numbers; onset: lowest critical
    wind speed of an oscillation; highest: highest wind speed asked for; design: the design wind, if it was asked for
    and all motions at it are known [m/s].
    """

    moving: tuple[LimitCycleRow, ...]
    unknown: tuple[LimitCycleRow, ...]
    onset: float | None
    highest: float | None
    design: float | None = None

    @property
    def outcomes(self) -> set[Outcome]:
        """How stable motions, and motions without numbers, ended."""
        return {row.outcome for row in (*self.moving, *self.unknown)}

    @property
    def loses_stability(self) -> bool:
        """Whether the span at rest loses stability up to the highest wind speed, at any if none was asked for."""
        return self.onset is not None and (self.highest is None or self.onset <= self.highest)

    @property
    def gallops(self) -> Gallops:
        """The answer: the wind starts a motion, or keeps up one that something else has started."""
        if self.moving or self.loses_stability or Outcome.NO_BOUNDED_MOTION in self.outcomes:
            return "yes"
        return "undecided" if self.unknown or self.highest is None else "no"


def verdict(result: Result, line: Line, analysis: Analysis) -> VerdictRow:
    """Return the verdict on a line at wind speeds up to the highest one that was asked for.

    Parameters
    ----------
    result : Result
        With all other tables.
    line : Line
    analysis : Analysis
    """
    evidence, samples = _evidence(result, line, analysis), overall(result)
    worst = evidence.moving[0] if evidence.moving else None
    tension = None if worst is None else _tension(result.tensions, worst)
    trust = _trust(evidence, tension, analysis)
    clearances = _clearances(result, evidence)
    gallops, sentence = weighed(result, evidence.gallops, _sentences(evidence, tension, clearances))
    return VerdictRow(
        gallops=gallops,
        onset_m_per_s=evidence.onset,
        worst_wind_m_per_s=None if worst is None else worst.wind_speed_m_per_s,
        worst_loops=None if worst is None else worst.loops,
        vertical_peak_to_peak_m=None if worst is None else _doubled(worst.vertical_m),
        horizontal_peak_to_peak_m=None if worst is None else _doubled(worst.horizontal_m),
        tension_range_n=_range(tension),
        largest_share_of_rated_strength=None if tension is None else tension.largest_share_of_rated_strength,
        clearance_m=_smallest(row.distance_m for row in clearances),
        clearance_margin_m=_smallest(row.margin_m for row in clearances),
        clearance_ok=_clearances_kept(clearances),
        ellipse_peak_to_peak_m=_ellipse(result, line),
        probability_gallops=None if samples is None else samples.probability,
        trust=trust,
        sentence=sentence,
        what_decides=what_decides(result),
    )


def _evidence(result: Result, line: Line, analysis: Analysis) -> _Evidence:
    rows, design, stable = result.limit_cycles, line.design_wind, Stability.STABLE
    unknown = tuple([row for row in rows if row.vertical_m is None])
    known = {row.wind_speed_m_per_s for row in rows} - {row.wind_speed_m_per_s for row in unknown}
    moving = [row for row in rows if row.kind != "equilibrium" and row.stability is stable]
    onsets = [
        row.wind_speed_m_per_s
        for row in result.critical_wind_speeds
        if row.crossing == "onset" and row.type == "oscillation"
    ]
    return _Evidence(
        moving=tuple(sorted(moving, key=lambda row: row.vertical_m or 0.0, reverse=True)),
        unknown=unknown,
        onset=min(onsets, default=None),
        highest=max(analysis.wind_speeds, default=None),
        design=design if design in known else None,
    )


def _tension(rows: Sequence[TensionRow], worst: LimitCycleRow) -> TensionRow | None:
    key = (worst.model, worst.loops, worst.wind_speed_m_per_s, worst.branch, worst.kind, worst.stability)
    same = (
        row
        for row in rows
        if (row.model, row.loops, row.wind_speed_m_per_s, row.branch, row.kind, row.stability) == key
    )
    return max(same, key=lambda row: row.largest_at_support_n or 0.0, default=None)


def _trust(evidence: _Evidence, tension: TensionRow | None, analysis: Analysis) -> Trust:
    slack = tension is not None and tension.outcome is Outcome.SLACK
    if slack or evidence.outcomes & _BEYOND:
        return "beyond_data"
    differences = [row.direct_difference for row in evidence.moving]
    agree = all(difference is not None and abs(difference) <= AGREEMENT for difference in differences)
    decided = evidence.gallops != "undecided" and not evidence.unknown and evidence.highest is not None
    return "checked" if analysis.check is Check.DIRECT and agree and decided else "plausible"


def _range(tension: TensionRow | None) -> float | None:
    if tension is None or tension.largest_at_support_n is None or tension.smallest_at_support_n is None:
        return None
    return tension.largest_at_support_n - tension.smallest_at_support_n


def _ellipse(result: Result, line: Line) -> float | None:
    ellipse = galloping_ellipse(
        EllipseMethod.CIGRE,
        result.static.sag_m,
        diameter=line.conductor.diameter,
        subconductors=len(line.bundle.positions),
    )
    return None if ellipse is None else ellipse.major_axis


def _clearances(result: Result, evidence: _Evidence) -> list[PhaseClearanceRow]:
    """Return the clearances of stable motions, where these are all known."""
    if evidence.gallops != "yes" or evidence.unknown:
        return []
    return [row for row in result.clearances if row.method == "computed" and row.stability is Stability.STABLE]


def _smallest(lengths: Iterable[float | None]) -> float | None:
    return min((length for length in lengths if length is not None), default=None)


def _clearances_kept(rows: Sequence[PhaseClearanceRow]) -> bool | None:
    """Return whether all phases keep their distance; None where one of them is given none, or none moves."""
    kept = [row.ok for row in rows]
    if False in kept:
        return False
    return None if not kept or None in kept else True


def _doubled(amplitude: float | None) -> float | None:
    return None if amplitude is None else 2.0 * amplitude


def _closeness(rows: Sequence[PhaseClearanceRow]) -> str:
    """Return how near the motions come to another phase, as a part of a sentence; empty where that is not known."""
    distance, kept = _smallest(row.distance_m for row in rows), _clearances_kept(rows)
    if distance is None:
        return ""
    if distance <= 0.0:
        return "; may touch the next phase"
    if kept is False:
        return f"; comes within {distance:.1f} m of the next phase, nearer than required"
    return f"; keeps {distance:.1f} m to the next phase"


def _sentences(evidence: _Evidence, tension: TensionRow | None, clearances: Sequence[PhaseClearanceRow]) -> list[str]:
    if evidence.gallops == "no":
        return [_rest(evidence)]
    if evidence.gallops == "undecided":
        return ["Not decided.", *_reasons(evidence)]
    texts = [_motion(evidence, clearances)]
    below = [row.wind_speed_m_per_s for row in evidence.moving if row.wind_speed_m_per_s < (evidence.onset or 0.0)]
    if below and evidence.loses_stability:
        texts.append(f"Once started, it goes on from {min(below):g} m/s.")
    if evidence.moving and evidence.moving[0].outcome in _BEYOND:
        texts.append(f"The size is not to be relied on: {_lowered(evidence.moving[0].outcome.sentence)}")
    if tension is not None and tension.outcome is Outcome.SLACK:
        texts.append(tension.outcome.sentence)
    share = None if tension is None else tension.largest_share_of_rated_strength
    if share is not None and share > 1.0:
        texts.append(f"The tension reaches {share:.0%} of the rated strength.")
    return texts + _reasons(evidence)


def _rest(evidence: _Evidence) -> str:
    later = "" if evidence.onset is None else f"; it would lose stability at {evidence.onset:.1f} m/s"
    return f"Stays at rest at the wind speeds asked for, up to {evidence.highest:g} m/s{later}."


def _motion(evidence: _Evidence, clearances: Sequence[PhaseClearanceRow]) -> str:
    """Return from which wind it gallops, the motions at the design wind and the worst, and what is left to phases."""
    if evidence.loses_stability:
        text = f"Gallops from {evidence.onset:.1f} m/s"
    elif evidence.moving:
        lowest = min(row.wind_speed_m_per_s for row in evidence.moving)
        text = f"Can gallop from {lowest:g} m/s on if something starts it, though the span at rest is stable"
    else:
        text = "Gallops"
    if not evidence.moving:
        return f"{text}; how far was not found."
    worst, design = evidence.moving[0], evidence.design
    if design is None or design == worst.wind_speed_m_per_s:
        return f"{text}; at {_size(worst)}{_closeness(clearances)}."
    there = next((row for row in evidence.moving if row.wind_speed_m_per_s == design), None)
    near = _closeness([row for row in clearances if row.wind_speed_m_per_s == design])
    put = (
        f"at the design wind of {design:g} m/s no stable motion was found"
        if there is None
        else f"at {_size(there)}{near}"
    )
    return f"{text}; {put}; most at {_size(worst)}{_closeness(clearances)}."


def _size(motion: LimitCycleRow) -> str:
    """Return wind speed, loops and size of a motion."""
    size = _metres(_doubled(motion.vertical_m) or 0.0)
    return f"{motion.wind_speed_m_per_s:g} m/s in {_in_words(motion)}, {size} m peak to peak"


def _reasons(evidence: _Evidence) -> list[str]:
    """Return why motions have no numbers, with the wind speeds of each reason."""
    texts = []
    if evidence.highest is None:
        texts.append("No wind speed was asked for.")
    for outcome in dict.fromkeys(row.outcome for row in evidence.unknown):
        winds = sorted({row.wind_speed_m_per_s for row in evidence.unknown if row.outcome is outcome})
        if outcome is Outcome.STATICALLY_UNSTABLE:
            texts.append(outcome.sentence)
        else:
            texts.append(f"At {', '.join(f'{wind:g}' for wind in winds)} m/s: {_lowered(outcome.sentence)}")
    return texts


def _lowered(sentence: str) -> str:
    return sentence[0].lower() + sentence[1:]


def _metres(length: float) -> str:
    return f"{length:.2f}" if length >= 0.1 else f"{length:.2g}"


def _in_words(motion: LimitCycleRow) -> str:
    loops = motion.loops
    if motion.span is not None:
        return f"mode {loops} of the section, most in span {motion.span}"
    return {1: "one loop", 2: "two loops", 3: "three loops"}.get(loops, f"{loops} loops")
