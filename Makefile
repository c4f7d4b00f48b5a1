# `make` rebuilds everything, report included; `make test` runs the tests.
# Both bootstrap .venv from requirements.lock first and do nothing twice.
PYTHON ?= python3.11
VENV := .venv
export PATH := $(CURDIR)/$(VENV)/bin:$(PATH)
# The user's own settings of Python and pip stay out of the environment.
unexport PYTHONPATH PYTHONHOME PYTHONSTARTUP PYTHONUSERBASE PIP_TARGET PIP_PREFIX PIP_ROOT
export PIP_USER := 0
PIP := $(VENV)/bin/python -m pip install --quiet --disable-pip-version-check

.DEFAULT_GOAL := all
.PHONY: all test test-site explain compare accept what-ifs lint animations flight benchmark faults determinism lock clean lab dag scale test-slurm test-crate verify audit drift bench waiting

all: $(VENV)/installed
	@snakemake all
	@cat data/results/verdicts.accepted
	@echo "report: report/build/report.pdf and report/build/site/index.html"

# An environment knows its folder by name: in a moved or copied checkout it is made anew.
ifneq "$(shell cat $(VENV)/installed 2>/dev/null)" "$(CURDIR)"
.PHONY: $(VENV)/installed
endif

$(VENV)/installed: requirements.lock pyproject.toml
	@command -v $(PYTHON) >/dev/null || { echo "make: $(PYTHON) not found; install Python 3.11 with venv, or name another: make PYTHON=python3" >&2; exit 2; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' || { echo "make: $(PYTHON) is $$($(PYTHON) --version 2>&1); needed is Python 3.11, for which requirements.lock is made; name it: make PYTHON=/path/to/python3.11" >&2; exit 2; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { echo "make: $(PYTHON) has no venv; install it (Debian: apt-get install python3.11-venv)" >&2; exit 2; }
	$(PYTHON) -m venv --clear $(VENV)
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-deps --no-build-isolation --editable .
	@printf '%s' "$(CURDIR)" > $@

# The tests read results and verdicts of their own, in runs/tests/; Snakemake makes them first,
# and each of its jobs notes the files that it opens.
TESTS_RUN = SMALLSAT_OPENED=$(CURDIR)/runs/tests/opened snakemake --configfile config/tests.yaml --
test: $(VENV)/installed
	@$(TESTS_RUN) results
	@python -m pytest -n 2 --dist loadfile --cov --cov-report=term --cov-report=html

# The web site of the tests' run in Debian's chromium. Once its driver is there, `make test` does so too.
test-site: $(VENV)/browser
	@command -v chromium >/dev/null || { echo "make: chromium not found; install it (Debian: apt-get install chromium)" >&2; exit 2; }
	@$(TESTS_RUN) verdicts
	@python -m pytest tests/site

$(VENV)/browser: requirements.browser.lock $(VENV)/installed
	$(PIP) --require-hashes -r requirements.browser.lock
	@touch $@

# The profile slurm on a Slurm of one node on this machine, installed where that is allowed; what it
# saw goes into a tracked table.
test-slurm: $(VENV)/installed
	$(PIP) --require-hashes -r requirements.slurm.lock
	@trap 'tests/workflow/cluster stop runs/cluster' EXIT; \
	tests/workflow/cluster start runs/cluster && python -m pytest tests/workflow/test_slurm.py && \
	cp runs/cluster/slurm.csv data/accepted/pipeline/

# All that is known of a printed value, erratum, claim, table or figure; RUN=runs/<name> for a what-if.
explain: $(VENV)/installed
	@python -m smallsat explain "$$ID" $(if $(RUN),--run "$$RUN")

# Holds a finished build against the record that it ends with, or against another one: CRATE=...
verify: $(VENV)/installed
	@python -m smallsat verify $(if $(CRATE),--crate "$$CRATE")

# The record of a build against the profile that it follows, whose vocabularies are fetched once.
CRATES := .cache/crate
test-crate: $(CRATES)/bin/rocrate-validator
	@$< cache warm --cache-path $(CRATES)/http $(addprefix --url https://w3id.org/ro/,crate/1.1/context terms/workflow-run/context) > $(CRATES)/warm.log || { echo "make: w3id.org does not answer, and the vocabularies of the profile are not in $(CRATES)/http yet; try again with a network" >&2; exit 2; }
	@$< --no-interactive validate --offline --cache-path $(CRATES)/http --no-paging --profile-identifier provenance-run-crate-0.5 .

$(CRATES)/bin/rocrate-validator: requirements.crate.lock
	$(PYTHON) -m venv --clear $(CRATES)
	$(CRATES)/bin/python -m pip install --quiet --require-hashes -r $<
	@touch $@

# Known vulnerabilities of what requirements.lock names.
audit: $(VENV)/installed
	$(PIP) --require-hashes -r requirements.audit.lock
	@python tests/audit/run.py

# All studies, or one, STUDY=mars, with the newest versions of all packages beside the locked ones: which numbers move.
drift: $(VENV)/installed
	@python tests/drift/run.py $(STUDY)

# What-if runs side by side, and beside the reproduction, in one page: RUNS="runs/heavier runs/lighter".
compare: $(VENV)/installed
	@python -m smallsat compare $(RUNS)

# Takes the present results, of the reproduction and of the tests' run, as accepted; REASON says why.
accept: $(VENV)/installed
	@snakemake verdicts
	@$(TESTS_RUN) verdicts
	@python -m smallsat accept --reason "$$REASON"
	@python -m smallsat seconds logs --output data/accepted/seconds.csv

# The notebooks in JupyterLab, which the first call installs; what they draw goes into runs/lab.
# LAB has options of JupyterLab, such as --no-browser.
lab: $(VENV)/lab
	@python -m smallsat lab -- $(LAB)

$(VENV)/lab: requirements.lab.lock $(VENV)/installed
	$(PIP) --require-hashes -r requirements.lab.lock
	@touch $@

# Modest changes of every study, one line each: done, refused with the reason, or not converged.
what-ifs: $(VENV)/installed
	@python tests/what_ifs/run.py $(ONLY)

lint: $(VENV)/installed
	ruff check .
	ruff format --check .
	snakefmt --check Snakefile rules
	mypy
	lint-imports
	snakemake --lint

animations: $(VENV)/installed
	@snakemake animations

# The picture of docs/architecture.md, from Snakemake's own graph of the rules.
dag: $(VENV)/installed
	@snakemake --quiet all --rulegraph mermaid-js all | python -m smallsat dag --output docs/dag.svg

# Chapter 6 of the rendezvous study counted anew on an emulated flight computer; every build takes
# the tables that this exchanges.
flight: $(VENV)/installed
	@flight/install
	@snakemake rendezvous_flight_measurement
	@mkdir -p data/accepted/rendezvous/flight
	@cp data/results/rendezvous/flight/measured/*.csv data/accepted/rendezvous/flight/

benchmark: $(VENV)/installed
	python benchmarks/run.py

# A small build is struck at seeded moments, killed, interrupted, out of disk, its files damaged; the
# next one has to end alike. As root, which mounts the full disk. FAULTS names some of them.
faults: $(VENV)/installed
	@python -m tests.faults.run $(FAULTS)

# Two builds varied as reprotest varies them, and one on another kernel of OpenBLAS, as root.
# CONFIG= is the full configuration; ONLY names studies.
determinism: CONFIG ?= config/quick.yaml
determinism: $(VENV)/installed
	@command -v disorderfs localedef >/dev/null || { echo "make: disorderfs and localedef not found; install them (Debian: apt-get install disorderfs locales)" >&2; exit 2; }
	@python -m tests.determinism.run $(ONLY) $(if $(CONFIG),--configfile $(CONFIG))

# How far a sweep of rendezvous goes: half an hour of one core; then projected, from tracked tables.
scale: $(VENV)/installed
	python benchmarks/scale.py
	python benchmarks/scale_join.py
	python benchmarks/scale_projection.py

# Speed beside peers, which live in an environment of their own: what they ask for differs from the lock.
# One core each, so that processor seconds compare.
BENCH := .cache/bench
bench: $(BENCH)/installed
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BENCH)/bin/python benchmarks/peers/bench.py

$(BENCH)/installed: requirements.lock requirements.bench.lock
	$(PYTHON) -m venv --clear $(BENCH)
	$(BENCH)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements.lock
	$(BENCH)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --require-hashes -r requirements.bench.lock
	$(BENCH)/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $@

# What a person waits for in a fresh clone, against its goal: an hour and more of both cores; WAITS names some of it.
waiting: $(VENV)/installed
	@python -m benchmarks.waiting $(WAITS)

# Needs uv (pip install uv); only for changing dependencies.
lock:
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.in -o requirements.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.browser.in -c requirements.lock -o requirements.browser.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.lab.in -c requirements.lock -o requirements.lab.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.slurm.in -c requirements.lock -o requirements.slurm.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 flight/requirements.in -o flight/requirements.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 flight/requirements.unicorn.in -o flight/requirements.unicorn.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.audit.in -c requirements.lock -o requirements.audit.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.crate.in -o requirements.crate.lock
	uv pip compile --generate-hashes --no-header --python-version 3.11 requirements.bench.in -c requirements.lock --override requirements.bench.overrides -o requirements.bench.lock

clean:
	rm -rf report/build runs logs .snakemake .cache
	find data/results figures -mindepth 1 ! -name README.md -delete
