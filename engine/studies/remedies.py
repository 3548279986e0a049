"""A line without and with each of a list of remedies, all compared by the same analysis and the same samples."""

import math
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass, replace

from engine.arrays import placed
from engine.progress import Progress, translated
from engine.result import Result
from engine.spec import (
    AddedSpoiler,
    Analysis,
    ChangedTension,
    DeviceEffect,
    Line,
    Model,
    MovedDevices,
    Remedies,
    Remedy,
    Uncertainty,
    check_remedies,
    separation_on,
)
from engine.spec.remedies import Placed
from engine.studies.arrangements import Places, Room, room_on
from engine.studies.judgement import Figures, common_models, few, figures, is_worse, judged
from engine.studies.place_search import MOST_ROUNDS, Found, Score, search
from engine.studies.remedy_rows import Tried, remedy_rows
from engine.studies.usual_remedies import usual_remedies
from engine.uncertainty.outcomes import SampleOutcome, State
from engine.uncertainty.runs import analysed, outcomes, sampled_analysis
from engine.uncertainty.weighing import Unknowns, Weighed, weighed_with_samples

FINALISTS = 3  # arrangements that the full analysis compares with the line as it is
ALONE, SEARCHED, ANALYSED = 0.2, 0.6, 0.7  # of the progress, at the end of each step

Restrung = Callable[[ChangedTension, Mapping[str, float]], Line]
"""Gives the line of chosen values, as those of `Unknowns`, with another tension."""


@dataclass(frozen=True, slots=True)
class Subject:
    """The line that remedies are for, what is uncertain of it, and how it is strung to another tension."""

    line: Line
    unknowns: Unknowns
    restrung: Restrung


@dataclass(frozen=True, slots=True)
class _Proposal:
    """A remedy with the arrangements to compare, the best first; arrangements: how many a search computed."""

    remedy: Remedy
    places: tuple[Places | None, ...]
    arrangements: int | None = None


def compare(
    subject: Subject, analysis: Analysis, remedies: Remedies, asked: Uncertainty
) -> Generator[Progress, None, Result]:
    """Compare a line as it is with each remedy.

    Places are searched with the hybrid model from arrangements of practice on; the separation is kept, and no
    arrangement is proposed that is worse than the line as it is. What was found is then analysed like the line as it
    is, and in the same samples.

    Parameters
    ----------
    subject : Subject
    analysis : Analysis
    remedies : Remedies
    asked : Uncertainty

    Yields
    ------
    Progress

    Returns
    -------
    Result
        Of the line as it is, with the table `remedies`.

    Raises
    ------
    InvalidSpec
        If a remedy does not fit the line or the analysis.
    """
    check_remedies(subject.line, analysis, remedies)
    tried_ones, notes = remedies.tried, list[str]()
    if tried_ones is None:
        tried_ones, notes = usual_remedies(subject.line, analysis, remedies.separation)
    plain = replace(analysis, device_effect=DeviceEffect.NEGLECTED)
    weighed = yield from translated(_weighed(subject, plain, asked), _between(0.0, ALONE))
    study = _Study(subject, plain, separation_on(subject.line, remedies.separation), weighed)
    proposals = []
    for number, remedy in enumerate(tried_ones):
        part = (SEARCHED - ALONE) / len(tried_ones)
        first = ALONE + number * part
        proposals.append((yield from translated(study.proposal(remedy), _between(first, first + part))))
    yield Progress(SEARCHED, "analysis with each remedy")
    tried = study.tried(proposals)
    for number, one in enumerate(tried):
        first = ANALYSED + (1.0 - ANALYSED) * number / len(tried)
        last = ANALYSED + (1.0 - ANALYSED) * (number + 1) / len(tried)
        of_samples = yield from translated(study.samples(one), _between(first, last))
        tried[number] = replace(one, outcomes=tuple(of_samples))
    yield Progress(1.0, "done")
    warnings = (*weighed.result.warnings, *notes)
    return replace(
        weighed.result, warnings=warnings, remedies=remedy_rows(weighed.result, weighed.outcomes, tried, plain)
    )


def _weighed(subject: Subject, analysis: Analysis, asked: Uncertainty) -> Generator[Progress, None, Weighed]:
    return (yield from weighed_with_samples(subject.line, analysis, subject.unknowns, asked))


@dataclass(frozen=True, slots=True)
class _Study:
    """What all remedies share: the line as it is, its results, and the separation to keep [m]."""

    subject: Subject
    analysis: Analysis
    separation: float
    weighed: Weighed

    def proposal(self, remedy: Remedy) -> Generator[Progress, None, _Proposal]:
        """Return a remedy with its places as given, or those that a search finds."""
        if isinstance(remedy, ChangedTension):
            return _Proposal(remedy, (None,))
        if remedy.positions is not None:
            return _Proposal(remedy, (tuple(sorted(remedy.positions)),))
        found = yield from self._searched(remedy)
        return _Proposal(remedy, found.places[:FINALISTS], found.arrangements)

    def _searched(self, remedy: Placed) -> Generator[Progress, None, Found]:
        line, length = self.subject.line, self.subject.line.span.length
        count = len(remedy.devices(line)) if isinstance(remedy, MovedDevices) else remedy.count
        probe = remedy.on(line, [length * (i + 1) / (count + 1) for i in range(count)])
        tied = bool(probe.interphase_spacers)  # only the finite element model knows them, and takes long
        asked = replace(self.analysis, models=(Model.FINITE_ELEMENT,)) if tied else sampled_analysis(self.analysis)
        asked = replace(asked, wind_speeds=few(asked.wind_speeds), risk=False)
        (alone,) = analysed([line], asked)
        without = Figures(math.nan) if isinstance(alone, State) else figures(alone, asked.models[0], asked)

        def scores(several: Sequence[Places]) -> list[Score]:
            found = analysed([remedy.on(line, places) for places in several], asked)
            return [_score(without, one, asked) for one in found]

        return (yield from search(count, self._room(remedy), length, scores, rounds=0 if tied else MOST_ROUNDS))

    def _room(self, remedy: Placed) -> Room:
        line = self.subject.line
        if isinstance(remedy, AddedSpoiler):
            half = 0.5 * remedy.length
            return Room(half, line.span.length - half, self.separation)
        kept = line
        if isinstance(remedy, MovedDevices):
            kept = replace(line, devices=tuple(d for d in line.devices if not isinstance(d, remedy.moved)))
        return room_on(kept, self.separation)

    def changed(self, remedy: Remedy, places: Places | None) -> Line:
        """Return the line with a remedy, all values as assumed."""
        if isinstance(remedy, ChangedTension):
            return replace(self.subject.line, span=self.subject.restrung(remedy, {}).span)
        return remedy.on(self.subject.line, places or ())

    def tried(self, proposals: Sequence[_Proposal]) -> list[Tried]:
        """Analyse the line with every remedy.

        Of searched places the first ones count that are better by every model, if there are any.
        """
        found = analysed([self.changed(one.remedy, one.places[0]) for one in proposals if one.places], self.analysis)
        results = placed(found, [bool(one.places) for one in proposals])
        return [self._tried(one, own) for one, own in zip(proposals, results, strict=True)]

    def _tried(self, proposal: _Proposal, first: Result | State | None) -> Tried:
        tried = Tried(proposal.remedy, arrangements=proposal.arrangements)
        for number, places in enumerate(proposal.places):
            line = self.changed(proposal.remedy, places)
            found = first if number == 0 else analysed([line], self.analysis)[0]
            if found is None or isinstance(found, State):
                tried = replace(tried, change="undecided")
                continue
            change = judged(self.weighed.result, found, self.analysis)
            given = proposal.arrangements is None
            if given or change == "better" or (change == "undecided" and not self._is_known):
                return replace(tried, line=line, places=places, result=found, change=change)
        return tried if proposal.arrangements is None else replace(tried, change="no_improvement")

    @property
    def _is_known(self) -> bool:
        """Whether the line as it is has figures to compare with, by every model."""
        result = self.weighed.result
        found = [figures(result, model, self.analysis) for model in common_models(result)]
        return all(math.isfinite(one.size or 0.0) and not math.isnan(one.onset) for one in found)

    def samples(self, tried: Tried) -> Generator[Progress, None, list[SampleOutcome]]:
        """Return what becomes of the samples of the line as it is with the remedy; nothing for tied phases."""
        line, remedy = tried.line, tried.remedy
        if line is None or line.interphase_spacers or not self.weighed.chosen:
            return []

        def line_of(chosen: Mapping[str, float]) -> Line:
            if isinstance(remedy, ChangedTension):
                return self.subject.restrung(remedy, chosen)
            return remedy.on(self.subject.unknowns.line_of(chosen), tried.places or ())

        asked = replace(self.analysis, risk=False)
        return (yield from outcomes(self.weighed.chosen, line_of, asked))


def _score(without: Figures, found: Result | State, analysis: Analysis) -> Score:
    """Return the largest motion and, less is better, the onset below the limit; infinite if worse than nothing."""
    if isinstance(found, State):
        return math.inf, math.inf
    changed = figures(found, analysis.models[0], analysis)
    if is_worse(without, changed):
        return math.inf, math.inf
    return changed.size or 0.0, -min(changed.onset, analysis.critical_wind_limit)


def _between(first: float, last: float) -> Callable[[Progress], Progress]:
    """Return how the progress of a step becomes that of the whole."""
    return lambda step: Progress(first + (last - first) * step.fraction, step.step)
