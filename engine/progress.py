"""Computations that report their progress: generators that yield while they run and return what they computed.

The only place that catches the end of a generator.
"""

from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import Any, TypeVar

Step = TypeVar("Step")
Other = TypeVar("Other")
Answer = TypeVar("Answer")
Value = TypeVar("Value")


@dataclass(frozen=True, slots=True)
class Progress:
    """How far an analysis is: fraction from 0 to 1 and the step at hand in words."""

    fraction: float
    step: str


def finished(steps: Generator[Any, None, Value]) -> Value:
    """Run a generator to its end and return its value."""
    return driven(steps, lambda _: None)


def driven(steps: Generator[Step, Answer | None, Value], answer: Callable[[Step], Answer | None]) -> Value:
    """Run a generator to its end, send it the answer to each thing that it yields, and return its value."""
    reply: Answer | None = None
    while True:
        try:
            step = steps.send(reply)
        except StopIteration as end:
            value: Value = end.value
            return value
        reply = answer(step)


def translated(steps: Generator[Step, None, Value], into: Callable[[Step], Other]) -> Generator[Other, None, Value]:
    """Yield what each step of a generator is turned into, and return the generator's value."""
    while True:
        try:
            step = steps.send(None)
        except StopIteration as end:
            value: Value = end.value
            return value
        yield into(step)
