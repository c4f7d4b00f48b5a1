# `make` rebuilds everything, report included; `make test` runs the tests.
# Both bootstrap .venv from requirements.lock first and do nothing twice.
PYTHON ?= python3.11
VENV := .venv
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)

.DEFAULT_GOAL := all
.PHONY: all test lint animations benchmark benchmark-baseline lock clean

all: $(VENV)/installed
	@snakemake all
	@python -m smallsat.evidence summary data/results/verdicts.csv

$(VENV)/installed: requirements.lock pyproject.toml
	@command -v $(PYTHON) >/dev/null || { echo "make: $(PYTHON) not found; install Python 3.11 with venv, or name another: make PYTHON=python3" >&2; exit 2; }
	$(PYTHON) -m venv $(VENV)
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.lock
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

# The published-value tests read verdicts of their own, in runs/tests/; Snakemake makes them first.
test: $(VENV)/installed
	@snakemake --configfile config/tests.yaml -- verdicts
	@python -m pytest

lint: $(VENV)/installed
	ruff check .
	ruff format --check .
	snakefmt --check Snakefile rules
	mypy
	lint-imports
	snakemake --lint

animations: $(VENV)/installed
	@snakemake animations

benchmark: $(VENV)/installed
	python benchmarks/run.py

# The side-by-side baseline of benchmarks/slew_speed.py; nothing else uses it.
# Without its dependencies, which would exchange the project's own CasADi.
benchmark-baseline: $(VENV)/installed
	$(VENV)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps yapss==0.2.3 mpmath==1.3.0

# Needs uv (pip install uv); only for changing dependencies.
lock:
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.in -o requirements.lock

clean:
	rm -rf data/results figures report/build runs logs .snakemake
