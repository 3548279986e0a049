# Every target does its own set-up; a fresh machine needs only Python >= 3.11 with pip.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# One BLAS thread: BLAS threads and forked workers can deadlock, and one process a core is faster here.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

.PHONY: setup demo test test-processes test-clients test-pages page-pictures test-faults reliability check bench capacity validation

setup: $(VENV)/.ready

$(VENV)/.ready: pyproject.toml setup.py constraints.txt $(wildcard engine/kernels/*)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	touch $@

demo: setup
	$(BIN)/python -m app.cli.demo --output demo-output

# Tests that start, kill and restart whole processes, or run whole commands one after another: they mostly wait.
PROCESSES := tests/e2e tests/worker/test_lost_processes.py tests/worker/test_batches.py tests/worker/test_priorities.py \
	tests/app/test_serve.py tests/app/operation tests/app/routes/test_idempotent_crashes.py tests/app/cli/test_demo.py \
	tests/benchmarks/test_walkthrough.py

test: setup
	$(BIN)/python -m pytest -n 2 --dist worksteal $(PROCESSES:%=--ignore=%) tests

test-processes: setup
	$(BIN)/python -m pytest -n 2 --dist worksteal $(PROCESSES)

# Generates clients from the OpenAPI document and runs them. The generators have an environment of their own; those that
# run with node or Java are skipped where these are not installed.
CLIENTS := .clients

$(CLIENTS)/.ready: tests/clients/generators.txt tests/clients/package.json tests/clients/package-lock.json
	$(PYTHON) -m venv $(CLIENTS)
	$(CLIENTS)/bin/pip install --quiet --disable-pip-version-check --requirement tests/clients/generators.txt
	cp tests/clients/package.json tests/clients/package-lock.json $(CLIENTS)/
	! command -v npm >/dev/null || npm ci --prefix $(CLIENTS) --ignore-scripts --no-audit --no-fund --silent
	touch $@

test-clients: setup $(CLIENTS)/.ready
	$(BIN)/python -m pytest tests/clients

# Opens every page in the chromium of the system; CHROMIUM names another one.
test-pages: setup
	$(BIN)/python -m pytest tests/browser

# Takes pictures of the pages into docs/pictures/.
page-pictures: setup
	$(BIN)/python -m benchmarks.page_pictures

# Kills and restarts processes for some seven minutes and prints the figures; `make reliability` writes them into
# docs/reliability.md.
test-faults: setup
	$(BIN)/python -m pytest --timeout 2400 tests/faults
	$(BIN)/python -m tests.faults.report

reliability: test-faults
	$(BIN)/python -m tests.faults.report --write

check: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/python -m benchmarks.house
	$(BIN)/mypy

bench: setup
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[bench]'
	$(BIN)/python -m benchmarks

capacity: setup
	$(BIN)/python -m benchmarks.capacity

validation: setup
	$(BIN)/python -m benchmarks.validation
