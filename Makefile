# Every target does the set-up that it needs; Python >= 3.11 with pip is all that a fresh machine has to have.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# One BLAS thread: threads and forked workers freeze each other, and one process a core is faster here.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

.PHONY: setup demo test test-faults reliability check bench capacity validation

setup: $(VENV)/.ready

$(VENV)/.ready: pyproject.toml constraints.txt $(wildcard engine/kernels/*)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	touch $@

demo: setup
	$(BIN)/python -m app.cli.demo --output demo-output

test: setup
	$(BIN)/python -m pytest -n 2 --dist worksteal tests

# Kills and restarts for some seven minutes, prints what it measured; `make reliability` puts it on docs/reliability.md.
test-faults: setup
	$(BIN)/python -m pytest --timeout 840 tests/faults
	$(BIN)/python -m tests.faults.report

reliability: test-faults
	$(BIN)/python -m tests.faults.report --write

check: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/lint-imports
	$(BIN)/mypy

bench: setup
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[bench]'
	$(BIN)/python -m benchmarks

capacity: setup
	$(BIN)/python -m benchmarks.capacity

validation: setup
	$(BIN)/python -m benchmarks.validation
