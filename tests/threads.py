"""Calls at the same time, for tests of races."""

import threading
from collections.abc import Callable


def at_once(call: Callable[[int], None], count: int) -> None:
    """Call a function in several threads, which begin together."""
    barrier = threading.Barrier(count)
    errors: list[Exception] = []

    def begin(number: int) -> None:
        barrier.wait()
        try:
            call(number)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=begin, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
