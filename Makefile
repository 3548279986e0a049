# Every target does its own set-up; a fresh machine needs only Python >= 3.11 with pip.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# One BLAS thread: BLAS threads and forked workers can deadlock, and one process a core is faster here.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export MKL_NUM_THREADS := 1

.PHONY: audit sbom test-version test-versions lowest constraints-lowest setup demo test test-processes test-clients test-pages page-pictures test-faults reliability check bench capacity validation

setup: $(VENV)/.ready

$(VENV)/.ready: pyproject.toml setup.py constraints.txt $(wildcard engine/kernels/*)
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[dev]'
	touch $@

demo: setup
	$(BIN)/python -m app.cli.demo --output demo-output

# Tests that start, kill and restart whole processes, or run whole commands one after another: they mostly wait.
PROCESSES := tests/e2e tests/engine/kernels/test_sanitized.py \
	tests/worker/test_lost_processes.py tests/worker/test_batches.py tests/worker/test_priorities.py \
	tests/worker/test_moved_clocks.py tests/worker/test_long_steps.py \
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

# Known faults of what is pinned. It asks a database on the network, and fails where that knows none of the pins: without
# --strict it would find no fault then.
audit: setup
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[audit]'
	$(BIN)/pip-audit --strict --requirement constraints.txt --disable-pip --no-deps

# What an installation holds, as CycloneDX; the image keeps its own as /opt/galloping/sbom.cdx.json.
sbom: setup
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[audit]'
	$(BIN)/cyclonedx-py environment --output-reproducible --output-file sbom.cdx.json $(BIN)/python

# The tests that meet the dependencies most, with the lowest versions that pyproject.toml allows, as constraints-lowest.txt
# has them. Warnings of old versions are no faults of ours.
LOWEST := tests/app/runtime tests/app/http tests/app/security tests/app/storage tests/app/export tests/app/sheets \
	tests/app/exchange tests/app/jobs tests/app/test_main.py tests/app/routes/test_jobs.py tests/app/routes/test_results.py \
	tests/app/routes/test_batches.py tests/app/cli/test_lines.py tests/app/client tests/app/plots/test_registry.py \
	tests/migrations tests/worker/test_courier.py tests/e2e/test_serve.py
LOWEST_TOOLS := pytest pytest-timeout pytest-xdist hypothesis pyyaml trustme pypdf packaging openapi-spec-validator

.venv-lowest/.ready: pyproject.toml setup.py constraints-lowest.txt $(wildcard engine/kernels/*)
	rm -rf .venv-lowest
	$(PYTHON) -m venv .venv-lowest
	.venv-lowest/bin/pip install --quiet --disable-pip-version-check --constraint constraints-lowest.txt --editable '.[all]' \
		$(LOWEST_TOOLS)
	touch $@

lowest: .venv-lowest/.ready
	PYTHONPATH=$(CURDIR) .venv-lowest/bin/python -m pytest -n 2 --dist worksteal -o filterwarnings=default $(LOWEST)

# Finds the lowest versions anew after a bound has changed.
constraints-lowest: setup
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt uv
	rm -rf .venv-lowest
	$(BIN)/uv venv --quiet --python $(BIN)/python .venv-lowest
	$(BIN)/uv pip compile --quiet --resolution lowest-direct --only-binary :all: --no-binary galloping --extra all \
		--no-emit-package galloping --output-file .venv-lowest/lowest.txt pyproject.toml
	$(BIN)/uv pip install --quiet --python .venv-lowest/bin/python --requirement .venv-lowest/lowest.txt
	$(BIN)/uv pip install --quiet --python .venv-lowest/bin/python --constraint .venv-lowest/lowest.txt $(LOWEST_TOOLS)
	$(BIN)/uv pip freeze --python .venv-lowest/bin/python > constraints-lowest.txt

# A few tests with one further version of Python, warnings as errors: kernels and solver, and of a wheel in an environment
# of its own, beside files of the names of our packages, the service with a job, the client and the command line.
# `make test-version PYTHON=python3.13 VENV=.venv-python3.13`; `make test-versions` does so for each that the machine has.
VERSION_TOOLS := hypothesis packaging pytest pytest-timeout pytest-xdist setuptools
ANY_VERSION := tests/engine/kernels/test_compiled.py tests/engine/cycles/test_harmonic_balance.py tests/engine/test_arrays.py \
	tests/e2e/test_wheel.py

$(VENV)/.version: pyproject.toml setup.py constraints.txt $(wildcard engine/kernels/*.[ch])
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[all]' $(VERSION_TOOLS)
	touch $@

test-version: $(VENV)/.version
	PYTHONPATH=$(CURDIR) $(BIN)/python -m pytest -n 2 --dist loadfile $(ANY_VERSION)

test-versions:
	.ci/versions

capacity: setup
	$(BIN)/python -m benchmarks.capacity

validation: setup
	$(BIN)/python -m benchmarks.validation
