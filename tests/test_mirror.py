"""The tree of tests mirrors the tree of modules, and no test module imports another.

`engine/cycles/search.py` is tested by `tests/engine/cycles/test_search.py`. A module without a test file of its own,
and a test file without a module of its own, stand in a list here with the reason.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TESTED = ("app", "engine", "migrations", "worker")

SCHEMA = (
    "It declares pydantic models; tests/app/test_schemas.py and the OpenAPI tests of tests/app/test_main.py hold it."
)
RULES = "Its rules are rows of the table in tests/engine/test_spec.py."
TABLE = (
    "It declares columns and constraints; tests/app/test_tables.py and tests/migrations/test_migrations.py hold them."
)

# An entry stands for a module, or for all modules of a package.
WITHOUT_A_TEST_FILE = {
    "app.answers": SCHEMA,
    "app.cli.__init__": "It registers the commands; tests/app/cli/test_lines.py runs them.",
    "app.cli.__main__": "It calls main; tests/app/cli/test_lines.py starts the command line through it.",
    "app.cli.console": "tests/app/cli/test_lines.py and operation/test_operate.py hold what it prints and writes.",
    "app.cli.inputs": "tests/app/cli/test_lines.py holds what it reads and refuses.",
    "app.cli.options": "It declares options; tests/app/cli/test_lines.py gives them.",
    "app.cli.remote.answers": "tests/app/cli/remote/test_jobs.py and test_batch.py hold what it prints and writes.",
    "app.cli.remote.calls": "tests/app/cli/remote/test_submit.py and test_jobs.py call through it.",
    "app.cli.operation.keys": "tests/app/cli/operation/test_operate.py makes, lists and revokes keys with it.",
    "app.distribution": "tests/e2e/test_wheel.py installs it, and calls it by both its names.",
    "app.convert.clearance": "tests/app/routes/test_clearance.py holds its figures.",
    "app.convert.known.own_rows": "It declares a dataclass; tests/app/convert/known/test_to_engine.py names its rows.",
    "app.convert.parts": "Every field that it converts is compared in tests/app/convert/test_assemble.py.",
    "app.convert.study": "tests/app/convert/test_check.py holds its faults, tests/app/convert/test_run.py its points.",
    "app.convert.tables": "tests/app/export/test_exported_columns.py and tests/app/test_result_tables.py hold it.",
    "app.interactive.busy": "tests/app/interactive/test_previews.py and test_workshop.py are refused by it.",
    "app.http.security_headers": "tests/app/security/test_gate.py finds its headers on every kind of answer.",
    "app.ogc.descriptions": "tests/app/ogc/test_routes.py holds them against the schemas of the standard.",
    "app.ogc.documents": "tests/app/ogc/test_routes.py holds them against the schemas of the standard.",
    "app.ogc.links": "tests/app/ogc/test_routes.py follows them.",
    "app.ogc.refusals": "tests/app/ogc/test_routes.py meets them.",
    "app.ogc.requests": "tests/app/ogc/test_routes.py posts and lists with them.",
    "app.openapi.line_forms": "tests/app/test_main.py finds both forms in the document.",
    "app.operation.workers": "tests/worker/test_presence.py and tests/app/operation/test_service_status.py hold it.",
    "app.pages.submitting": "tests/app/pages/views/test_start.py and test_line_form.py submit and are refused by it.",
    "app.pages.views.__init__": "It lists the routers; tests/app/pages/views/test_start.py opens their pages.",
    "app.routes.batch_status": "tests/app/routes/test_batches.py holds the documents of batches that it makes.",
    "app.routes.dependencies": "It hands settings, caller and sessions to routes; all tests of routes use it.",
    "app.routes.finished_jobs": "tests/app/routes/test_results.py holds its answers.",
    "app.routes.job_intake": "tests/app/routes/test_jobs.py and test_remedies.py post jobs through it.",
    "app.routes.job_status": "tests/app/routes/test_jobs.py holds the documents of jobs that it makes.",
    "app.routes.batch_documentation": "It holds examples; tests/app/test_main.py validates each by its schema.",
    "app.routes.batch_results": "tests/app/routes/test_batches.py reads results of every form from it.",
    "app.routes.deliveries": "tests/worker/test_courier.py reads the log and sends again through it.",
    "app.routes.documentation": "It holds examples; tests/app/test_main.py validates each by its schema.",
    "app.routes.events": "tests/app/routes/test_waiting.py follows its streams.",
    "app.routes.explorer": "tests/app/test_main.py opens its page and its files.",
    "app.routes.known_lines": "tests/app/routes/test_lines.py posts jobs through it.",
    "app.routes.own_documentation": "It holds examples; tests/app/test_main.py validates each by its schema.",
    "app.routes.reference_documentation": "It holds examples; tests/app/test_main.py validates each by its schema.",
    "app.schemas.batch": SCHEMA,
    "app.schemas.labels": SCHEMA,
    "app.schemas.devices": SCHEMA,
    "app.schemas.environment": SCHEMA,
    "app.schemas.fields": SCHEMA,
    "app.schemas.known": SCHEMA,
    "app.schemas.measured": SCHEMA,
    "app.schemas.placement": SCHEMA,
    "app.storage.migration": "tests/migrations/test_migrations.py migrates with it, several processes at once.",
    "app.tables": TABLE,
    "engine.kernels.layout": "Every kernel that tests/engine/kernels/test_compiled.py calls reads its models by it.",
    "engine.model_findings": "tests/engine/test_analysis.py and test_section_analysis.py compare what it finds.",
    "engine.report.observers.observer": "tests/engine/test_analysis.py holds positions and amplitudes of single spans.",
    "engine.report.sections.section_results": "tests/engine/test_section_analysis.py holds the results of sections.",
    "engine.report.bifurcations": "tests/app/routes/test_further_tables.py holds its rows.",
    "engine.cycles.branch_set": "tests/engine/cycles/test_branches.py and test_refinement.py follow branches with it.",
    "engine.numerics.branch_zeros": "tests/engine/numerics/test_continuation.py finds zeros on circles with it.",
    "engine.report.findings": "tests/engine/test_outcome.py and tests/engine/report/test_limit_cycles.py use it.",
    "engine.report.frequencies": "tests/validation/test_table_2.py holds its rows.",
    "engine.result": "It declares dataclasses; tests/app/convert/test_run.py holds their columns.",
    "engine.spec.analysis": RULES,
    "engine.spec.devices": RULES,
    "engine.spec.environment": RULES,
    "engine.spec.line": RULES,
    "engine.spec.physics": RULES,
    "engine.spec.placement": "tests/engine/studies/test_placement.py holds its rules.",
    "engine.spec.remedies": "tests/engine/studies/test_remedies.py holds its rules and the lines that it makes.",
    "engine.spec.rules": RULES,
    "engine.spec.span": RULES,
    "engine.spec.uncertainty": "tests/engine/test_spec.py holds its rules.",
    "engine.studies.field_branches": "tests/engine/studies/test_followed.py holds its branches, folds and Hopf points.",
    "engine.studies.remedy_rows": "tests/engine/studies/test_remedies.py compares its rows with analyses.",
    "migrations.env": "tests/migrations/test_migrations.py runs every revision through it.",
    "migrations.versions": "tests/migrations/test_migrations.py and tests/migrations/test_rows_are_kept.py run each.",
    "worker.__main__": "tests/worker/test_lost_processes.py starts, kills and stops it.",
    "worker.pool": "tests/worker/test_lost_processes.py kills its idle and its busy processes.",
}

# An entry stands for a test file, or for all of a folder.
OF_NO_SINGLE_MODULE = {
    "tests/app/convert/test_phases.py": "Phases of a request pass check, assembly and studies of the border.",
    "tests/app/convert/test_placement.py": "A search for places passes check, run and columns of the border.",
    "tests/app/convert/test_whole_lines.py": "Requests made by Hypothesis pass the whole border and the engine.",
    "tests/app/routes/test_further_tables.py": "Tables that are asked for are fetched in every form.",
    "tests/app/routes/test_idempotent_crashes.py": "A process is killed at each step of an idempotent post.",
    "tests/app/routes/test_exchange.py": "Features and CIM files pass reading, intake and results.",
    "tests/app/routes/test_spreadsheets.py": "Sheets of several programs pass reading, intake and results.",
    "tests/app/pages/views/test_owners.py": "Every page of jobs and batches is asked for by another owner.",
    "tests/app/test_costs.py": "SQL statements, messages and imports are counted on whole ways through the service.",
    "tests/app/test_result_tables.py": "A table that a test declares goes through every form of an answer.",
    "tests/benchmarks": "The benchmarks are tools: what others read from them is tested.",
    "tests/browser": "The pages are used in a real browser.",
    "tests/e2e": "The whole service runs as users start it.",
    "tests/engine/devices": "A device is held by the matrices and the motions that it changes.",
    "tests/engine/kernels/test_sanitized.py": "The kernels are called with spoilt arguments under sanitizers.",
    "tests/engine/test_coexisting_cycles.py": "Cycles that only the search as a whole finds are held on three lines.",
    "tests/engine/test_costs.py": "Systems solved a line are counted over the whole analysis.",
    "tests/engine/test_imports.py": "Every module of the engine may import a few others only.",
    "tests/engine/test_quasi_periodic_lines.py": "Three lines whose motion stays quasi-periodic pass search and tori.",
    "tests/clients": "Generators make clients of the whole API.",
    "tests/faults": "Processes, disks and networks fail under the whole service.",
    "tests/migrations": "Each revision is a step of one way up and down, which is tested as a whole.",
    "tests/test_documents.py": "It is about the documents of docs/.",
    "tests/test_lowest.py": "It is about the bounds of dependencies in pyproject.toml.",
    "tests/test_mirror.py": "It is about the tests.",
    "tests/validation": "The engine is held against its source and against other codes.",
    "tests/worker/test_batches.py": "Batches run through broker, pool and database while workers are killed.",
    "tests/worker/test_lost_processes.py": "Processes of workers are killed at every place.",
    "tests/worker/test_long_steps.py": "Jobs in a step of a minute are cancelled in real pools.",
    "tests/worker/test_moved_clocks.py": "Clocks of workers and of databases are set while jobs run.",
    "tests/worker/test_priorities.py": "A single job passes a batch in broker and pool.",
    "tests/worker/test_reused_lines.py": "What is stored answers batches and jobs, by API and worker.",
}


def modules() -> set[str]:
    """Return the dotted names of all modules, those `__init__.py` among them that define something."""
    paths = [path for top in TESTED for path in (ROOT / top).rglob("*.py")]
    return {dotted(path) for path in paths if path.name != "__init__.py" or defines(path.read_text(encoding="utf-8"))}


def dotted(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


def defines(text: str) -> bool:
    return any(isinstance(node, ast.FunctionDef | ast.ClassDef) for node in ast.parse(text).body)


def place_of(module: str) -> str:
    """Return the place of the test file of a module or package."""
    *packages, name = module.removesuffix(".__init__").split(".")
    return "/".join(["tests", *packages, f"test_{name.strip('_')}.py"])


def present_tests() -> set[str]:
    return {str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("test_*.py")}


def covered(name: str, entries: dict[str, str], separator: str) -> str | None:
    """Return the entry that stands for a module or a test file, by itself or for what it lies in."""
    return next((entry for entry in entries if name == entry or name.startswith(f"{entry}{separator}")), None)


def imported_tests(text: str) -> Iterator[str]:
    """Yield the test modules, and conftests, that a source text imports."""
    for node in ast.walk(ast.parse(text)):
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module or ''}.{alias.name}" for alias in node.names]
        for name in names:
            if any(part.startswith("test_") or part == "conftest" for part in name.split(".")):
                yield name


def test_every_module_has_a_test_file_or_a_reason() -> None:
    found, present = modules(), present_tests()
    assert len(found) > 200
    bare = {module for module in found if place_of(module) not in present}
    assert sorted(module for module in bare if covered(module, WITHOUT_A_TEST_FILE, ".") is None) == []
    needed = {covered(module, WITHOUT_A_TEST_FILE, ".") for module in bare}
    assert sorted(WITHOUT_A_TEST_FILE.keys() - needed) == []


def test_every_test_file_has_a_module_or_a_reason() -> None:
    packages = {dotted(path) for top in TESTED for path in (ROOT / top).rglob("__init__.py")}
    own = {place_of(module) for module in modules() | packages}
    homeless = present_tests() - own
    assert sorted(name for name in homeless if covered(name, OF_NO_SINGLE_MODULE, "/") is None) == []
    needed = {covered(name, OF_NO_SINGLE_MODULE, "/") for name in homeless}
    assert sorted(OF_NO_SINGLE_MODULE.keys() - needed) == []


def test_reasons_are_sentences_and_name_test_files_that_are_there() -> None:
    reasons = [*WITHOUT_A_TEST_FILE.values(), *OF_NO_SINGLE_MODULE.values()]
    assert [reason for reason in reasons if not re.fullmatch(r".{15,}\.", reason)] == []
    named = {name for reason in reasons for name in re.findall(r"tests/[\w/]+\.py", reason)}
    assert sorted(named - present_tests()) == []


@pytest.mark.parametrize("name", sorted({str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("*.py")}))
def test_no_module_imports_a_test_module(name: str) -> None:
    assert list(imported_tests((ROOT / name).read_text(encoding="utf-8"))) == []


def test_imports_of_test_modules_are_seen_however_they_are_written() -> None:
    text = "import tests.app.test_main as m\nfrom tests.app import service, test_main\ndef f():\n"
    text += (
        "    from tests.app.test_main import x\nfrom . import test_a\nfrom tests.conftest import x\nimport tests_x\n"
    )
    assert sorted(imported_tests(text)) == [
        ".test_a",
        "tests.app.test_main",
        "tests.app.test_main",
        "tests.app.test_main.x",
        "tests.conftest.x",
    ]
