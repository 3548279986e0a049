"""Generators that report their progress: their value, what they are sent, and what is made of their steps."""

from collections.abc import Generator

import pytest

from engine.progress import driven, finished, translated


def counting(last: int) -> Generator[int, str | None, list[str | None]]:
    """Yield 0, 1, ... and return what was sent in answer to each."""
    answers: list[str | None] = []
    while len(answers) < last:
        answer = yield len(answers)
        answers.append(answer)
    return answers


def test_a_finished_generator_has_its_value() -> None:
    assert finished(counting(3)) == [None, None, None]
    assert finished(counting(0)) == []


def test_each_step_is_answered() -> None:
    assert driven(counting(3), str) == ["0", "1", "2"]


def test_steps_are_passed_on_in_another_form_and_the_value_stays() -> None:
    seen: list[str] = []
    assert driven(translated(counting(2), lambda i: f"step {i}"), seen.append) == [None, None]
    assert seen == ["step 0", "step 1"]


def test_what_a_generator_raises_goes_through() -> None:
    def failing() -> Generator[int, None, int]:
        yield 1
        raise ArithmeticError("no")

    with pytest.raises(ArithmeticError, match="no"):
        finished(failing())
    with pytest.raises(ArithmeticError, match="no"):
        list(translated(failing(), str))


def test_an_iterator_that_runs_dry_in_an_answer_is_not_taken_for_the_end() -> None:
    empty: list[int] = []
    with pytest.raises(StopIteration):
        driven(counting(1), lambda _: str(next(iter(empty))))
