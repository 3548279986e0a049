"""Call the kernels as the engine does, then with arguments spoilt one by one: they refuse, and touch no foreign memory.

`python -m tests.engine.kernels.fuzz KERNELS.so ROUNDS` is run by `test_sanitized.py` with kernels built with
AddressSanitizer and UndefinedBehaviorSanitizer, which end the process where one does.
"""

import importlib.util
import random
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

NAMES = ("newton", "linearization", "monodromies", "eigenvalues", "even_parts", "reaches", "flows")
NUMBERS = (-1, 0, 1, 2, 3, 5, 8, 1 << 10, 1 << 20, (1 << 31) - 1, -(1 << 31), 1 << 40, 1 << 62, (1 << 63) - 1)
REFUSALS = (ValueError, IndexError, TypeError, OverflowError, BufferError, MemoryError)
SEED = 7

Call = tuple[str, tuple[Any, ...]]


def sanitized(path: Path) -> Any:
    """Load kernels from a file in the place of those of the package, before anything imports these."""
    name = "engine.kernels._kernels"
    description = importlib.util.spec_from_file_location(name, path)
    assert description is not None
    assert description.loader is not None
    module = importlib.util.module_from_spec(description)
    description.loader.exec_module(module)
    sys.modules[name] = module
    return module


def recorded(kernels: Any) -> list[Call]:
    """Return the arguments with which the engine calls each kernel, for cycles that alternate apart from others."""
    calls: dict[tuple[bool, str, tuple[Any, ...]], Call] = {}
    alternates = False

    def recording(name: str) -> Callable[..., Any]:
        real = getattr(kernels, name)

        def call(*arguments: Any) -> Any:
            calls.setdefault((alternates, name, _shape(arguments)), (name, _copied(arguments)))
            return real(*arguments)

        return call

    from engine.kernels import compiled  # noqa: PLC0415 - after the kernels are in their place
    from engine.spec import Model  # noqa: PLC0415
    from tests.builders import only, run, source_line  # noqa: PLC0415
    from tests.engine import motions  # noqa: PLC0415

    for name in NAMES:
        setattr(compiled, name, recording(name))
    run(source_line(2), only(Model.HYBRID, loops=(1,), wind_speeds=(1.0, 4.0)))
    made: Any
    for made in motions.MODELS.values():
        _exercise(made(), motions)
    alternates = True
    _exercise_alternating(motions)
    return list(calls.values())


def _exercise(model: Any, motions: Any) -> None:
    from engine.checks.direct_starts import spread_starts  # noqa: PLC0415
    from engine.checks.settled_motion import integrate_until_settled  # noqa: PLC0415
    from engine.cycles.floquet import floquet  # noqa: PLC0415
    from engine.cycles.harmonic_balance import balance, linearized  # noqa: PLC0415
    from engine.numerics.newton import NewtonOptions  # noqa: PLC0415

    members = model.mass.shape[0]
    member = np.arange(2) % members
    orbits = motions.random_orbits(model, 2, 2)
    balance(model, member, orbits, NewtonOptions(iterations=1))
    linearized(model, member, orbits)
    floquet(model, member, orbits)
    starts = spread_starts(model, member[:1], np.array([4.0]), (0.1,), np.random.default_rng(SEED))
    integrate_until_settled(model, member[[0] * starts.shape[1]], np.full(starts.shape[1], 4.0), starts[0], 1)


def _exercise_alternating(motions: Any) -> None:
    from engine.cycles.floquet import monodromy  # noqa: PLC0415
    from engine.cycles.harmonic_balance import Orbits, balance  # noqa: PLC0415
    from engine.numerics.newton import NewtonOptions  # noqa: PLC0415
    from tests.builders import hybrid  # noqa: PLC0415

    model = hybrid(motions.relative_line(2), 2, motions.STRETCHING)
    assert model.parity is not None
    assert model.parity.all()
    coefficients = np.zeros((2, 4, 7))
    coefficients[:, :3, 1] = 0.1
    orbits = Orbits(coefficients, np.full(2, 6.0), np.full(2, 4.0))
    balance(model, np.zeros(2, dtype=np.intp), orbits, NewtonOptions(iterations=2))
    monodromy(model, np.zeros(2, dtype=np.intp), orbits)


def _shape(value: Any) -> Any:
    return tuple(_shape(part) for part in value) if isinstance(value, tuple) else type(value)


def _copied(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(_copied(part) for part in value)
    return value.copy() if isinstance(value, np.ndarray) else value


def places(value: Any, path: tuple[int, ...] = ()) -> Iterator[tuple[int, ...]]:
    """Yield the paths to all parts of nested tuples."""
    if isinstance(value, tuple):
        for number, part in enumerate(value):
            yield (*path, number)
            yield from places(part, (*path, number))


def spoilt(value: Any, path: tuple[int, ...], draw: random.Random) -> Any:
    """Return nested tuples with the part at a path spoilt."""
    if path:
        parts = list(value)
        parts[path[0]] = spoilt(parts[path[0]], path[1:], draw)
        return tuple(parts)
    if isinstance(value, tuple):
        return value[: draw.randrange(len(value) + 1)] if draw.random() < 0.8 else [*value]
    if isinstance(value, np.ndarray):
        return _spoilt_array(value, draw)
    return draw.choice((*NUMBERS, None, 0.5, "x"))


def _spoilt_array(array: Any, draw: random.Random) -> Any:
    kind = draw.randrange(6)
    if kind == 0:
        return array.reshape(-1)[: draw.randrange(array.size + 1)].copy()
    if kind == 1:
        return np.append(array.reshape(-1), array.reshape(-1)[:1])
    if kind == 2:
        return array.astype(np.float32 if array.dtype == np.float64 else np.int32)
    if kind == 3:
        return None
    other = array.copy().reshape(-1)
    if other.size:
        odd = NUMBERS if array.dtype.kind == "i" else (np.nan, np.inf, -np.inf, 0.0, 1e308, -1e308, 1e-320)
        other[draw.randrange(other.size)] = draw.choice(odd)
    return other.reshape(array.shape)


def main() -> None:
    """Record, replay as they were, then spoil."""
    kernels = sanitized(Path(sys.argv[1]))
    draw, refused, passed = random.Random(SEED), 0, 0
    calls = recorded(kernels)
    assert {name for name, _ in calls} == set(NAMES), sorted({name for name, _ in calls})
    for name, arguments in calls:
        getattr(kernels, name)(*_copied(arguments))
    for _ in range(int(sys.argv[2])):
        name, arguments = draw.choice(calls)
        path = draw.choice(list(places(arguments)))
        try:
            getattr(kernels, name)(*spoilt(_copied(arguments), path, draw))
            passed += 1
        except REFUSALS:
            refused += 1
    sys.stdout.write(f"{len(calls)} calls, {refused} refused, {passed} passed\n")


if __name__ == "__main__":
    main()
