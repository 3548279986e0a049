"""The kernels under AddressSanitizer and UndefinedBehaviorSanitizer, with good and with spoilt arguments."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

from engine.kernels import compiled, layout
from tests.engine.motions import COPIES, MODELS, perturbed, random_orbits

ROOT = Path(__file__).parents[3]
SOURCES = sorted((ROOT / "engine/kernels").glob("*.c"))
FLAGS = ("-shared", "-fPIC", "-O1", "-g", "-std=gnu11", "-fno-math-errno", "-fno-wrapv", "-Wno-psabi")
SANITIZERS = ("-fsanitize=address,undefined,float-cast-overflow", "-fno-sanitize-recover=all")
ROUNDS = 3000


def library(name: str) -> Path | None:
    """Return the path of a library of the compiler; None where there is no gcc or it has none."""
    if shutil.which("gcc") is None:
        return None
    found = subprocess.run(["gcc", f"-print-file-name={name}"], capture_output=True, text=True, check=True)
    path = Path(found.stdout.strip())
    return path if path.is_absolute() else None


def test_no_argument_makes_the_kernels_touch_foreign_memory(tmp_path: Path) -> None:
    sanitizer, include = library("libasan.so"), Path(sysconfig.get_paths()["include"])
    if sanitizer is None or not (include / "Python.h").exists():
        pytest.skip("gcc, its libasan or the headers of Python are not installed")
    built = tmp_path / "_kernels.so"
    subprocess.run(["gcc", *FLAGS, *SANITIZERS, f"-I{include}", "-o", built, *SOURCES, "-lm"], check=True)
    environment = {
        **os.environ,
        "LD_PRELOAD": str(sanitizer),
        "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1",
    }
    environment |= {"PYTHONPATH": str(ROOT), "PYTHONMALLOC": "malloc"}
    command = [sys.executable, "-m", "tests.engine.kernels.fuzz", str(built), str(ROUNDS)]
    ended = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=240, check=False)
    assert ended.returncode == 0, ended.stderr[-4000:]
    refused = int(ended.stdout.split(", ")[1].split()[0])
    assert refused > ROUNDS // 3, ended.stdout


@pytest.mark.skipif(not compiled.AVAILABLE, reason="the kernels were not built")
@pytest.mark.parametrize("steps", [1 << 62, (1 << 62) + 4, (1 << 63) - 4])
def test_steps_whose_double_is_no_number_are_refused(steps: int) -> None:
    model = perturbed(next(iter(MODELS.values()))())
    orbits = random_orbits(model, 2, COPIES)
    member = np.zeros(COPIES, dtype=np.intp)
    parts = (member, np.linalg.inv(model.mass), orbits.coefficients, orbits.angular_frequency, orbits.wind_speed)
    rows = np.zeros((8, 5))
    with pytest.raises(ValueError, match="steps from row"):
        compiled.products_over_period(model, parts, (rows, rows), (np.full(COPIES, steps), member))


@pytest.mark.skipif(not compiled.AVAILABLE, reason="the kernels were not built")
def test_short_tuples_are_refused() -> None:
    model = perturbed(next(iter(MODELS.values()))())
    parts, shape = layout.model_parts(model), layout.model_shape(model)
    none, linearization = np.empty(0), vars(compiled)["linearization"]
    for count in range(len(parts)):
        with pytest.raises(ValueError, match=r"a tuple must hold (9|23) items"):
            linearization(parts[:count], shape, (0, 1), (none,) * 4, (none, none))
