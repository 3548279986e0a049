"""What a pool loads before it forks, and what its processes do with it."""

from tests.processes import printed


def test_a_job_finds_everything_loaded() -> None:
    script = """
import sys
from app import convert
from app.reference.source_lines import example
from worker.tasks import load
load()
before = set(sys.modules)
analysis = {"loops": [1], "models": ["hybrid"], "wind_speeds_m_per_s": [8.0]}
list(convert.run_stack(analysis, [convert.NumberedLine(1, example("c11-twin"))]))
print({name for name in set(sys.modules) - before if name.split(".")[0] in ("engine", "scipy", "app")})
"""
    assert printed(script) == "set()"


def test_every_process_of_a_pool_freezes_what_it_has() -> None:
    script = """
import gc, os
from celery.signals import worker_process_init
from worker import tasks
class Pool:
    def worker_main(self, _):
        assert gc.get_freeze_count() == 0
        worker_process_init.send(None)
tasks.worker_application = lambda *_: Pool()
os.environ[tasks.OWNER] = "here"
output = os.dup(1)
tasks._run_pool()
os.write(output, str(gc.get_freeze_count() > 50_000).encode())
print("what Celery says on standard output", flush=True)
"""
    assert printed(script) == "True"
