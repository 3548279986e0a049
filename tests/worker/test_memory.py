"""How a process that runs the engine handles memory."""

from tests.processes import printed


def test_what_is_loaded_is_not_looked_through_again() -> None:
    script = """
import gc
from worker.memory import settle
from worker.tasks import load
load()
before = len(gc.get_objects())
settle()
print(before > 50_000, len(gc.get_objects()) < 1_000, gc.isenabled())
"""
    assert printed(script) == "True True True"


def test_the_rows_of_a_chunk_are_not_looked_through() -> None:
    script = """
import gc
from worker.memory import settle
settle()
def collections():
    return sum(generation["collections"] for generation in gc.get_stats())
before = collections()
rows = [[] for _ in range(80_000)]
within = collections()
more = [[] for _ in range(40_000)]
print(within - before, collections() - before)
"""
    assert printed(script) == "0 1"


def test_freed_memory_is_kept_for_the_next_arrays() -> None:
    script = """
import resource
import numpy as np
from worker.memory import keep_freed_memory
def faults():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        arrays = [np.ones(2**20) for _ in range(8)]
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before
returned = faults()
keep_freed_memory()
faults()
print(returned > 20_000, faults() < 100)
"""
    assert printed(script) == "True True"
