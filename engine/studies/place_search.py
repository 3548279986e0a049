"""Local search for places: the best arrangement of practice, then small changes of it as long as they help."""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

from engine.progress import Progress
from engine.studies.arrangements import Places, Room, neighbours, practice

FIRST_STEP, LAST_STEP = 1 / 20, 1 / 80  # of the span
MOST_ROUNDS = 10
GAIN = 0.005  # relative improvement that is worth a move
DIGITS = 6  # to which scores are compared, so that mirror images are equal

Score = tuple[float, float]
"""What a search minimizes: the first number, and where it does not differ the second; infinite if not acceptable."""
Scores = Callable[[Sequence[Places]], Sequence[Score]]


@dataclass(frozen=True, slots=True)
class Found:
    """The best arrangements on the way, the best first, none where no one is acceptable; how many were computed."""

    places: tuple[Places, ...]
    arrangements: int


def search(
    count: int, room: Room, length: float, scores: Scores, *, rounds: int = MOST_ROUNDS
) -> Generator[Progress, None, Found]:
    """Search for the places of equal devices.

    The line's mirror image leads to the mirror image of the places, or to others of the same score.

    Parameters
    ----------
    count : int
        Number of devices.
    room : Room
    length : float
        Of the span [m].
    scores : callable
        Gives the scores of several arrangements at once.
    rounds : int
        Most rounds of changes; 0 for the arrangements of practice alone.

    Yields
    ------
    Progress
        Before each round.
    """
    starts = practice(count, room, length)
    known = dict(zip(starts, scores(starts), strict=True)) if starts else {}
    path = [min(known, key=lambda places: _rounded(known[places]))] if known else []
    step, number = FIRST_STEP * length, 0
    while path and number < rounds and step >= LAST_STEP * length:
        yield Progress(number / rounds, f"places, round {number + 1}")
        number += 1
        around = neighbours(path[-1], room, step, length)
        new = [places for places in around if places not in known]
        known |= dict(zip(new, scores(new), strict=True)) if new else {}
        best = min(around, key=lambda places: _rounded(known[places]), default=path[-1])
        if _is_gain(known[best], known[path[-1]]):
            path.append(best)
        else:
            step *= 0.5
    acceptable = [places for places in reversed(path) if known[places][0] < float("inf")]
    others = sorted((one for one in starts if known[one][0] < float("inf")), key=lambda one: _rounded(known[one]))
    return Found(tuple(dict.fromkeys([*acceptable, *others])), len(known))


def _rounded(score: Score) -> Score:
    first, second = (float(f"{number:.{DIGITS}g}") for number in score)
    return first, second


def _is_gain(new: Score, old: Score) -> bool:
    if old[0] == float("inf") or abs(new[0] - old[0]) > GAIN * abs(old[0]):
        return new[0] < old[0]
    return new[1] < old[1] - GAIN * abs(old[1])
