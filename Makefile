# `make demo` and `make test` need Python 3.11 or newer, pip and make, and nothing else.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
SCENARIO := out/demo.toml

# A test process on every core, each with one thread; what is costly to set up is shared by a group (`xdist_group`).
# Compiled files are kept even where the environment would rather not: they save a third of the collection.
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
TESTS = PYTHONDONTWRITEBYTECODE= OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 \
	$(BIN)/python -m pytest -q -n $(JOBS) --dist loadgroup

.PHONY: demo paper test test-slow lowest newest coverage bench speed cost against scale workers kills random fuzz honest accuracy faults calls lint format dist picture clean

demo: $(READY)
	@mkdir -p out
	@$(BIN)/movingfrf new $(SCENARIO) --force
	@$(BIN)/movingfrf run $(SCENARIO) --output out/demo

paper: $(READY)
	$(BIN)/movingfrf paper --output out/paper

test: $(READY) lint
	$(TESTS) -m "not slow"

# What `make test` leaves out: single tests of more than 5 s.
test-slow: $(READY)
	$(TESTS) -m slow

# All tests with the lowest versions that the package says it works with, or the newest, in an environment of their own.
lowest newest:
	PYTHON=$(PYTHON) JOBS=$(JOBS) tools/versions.sh $@

coverage: $(READY)
	$(TESTS) --cov --cov-report=term:skip-covered

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(READY)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# What every case costs, with numba and without, where the time goes, and the other methods.
bench: $(READY)
	$(BIN)/python -m benchmarks.bench

# Whether a case has become slower than `benchmarks/ratios.toml` says, with and without numba; UPDATE=1 writes into that
# file what is measured; ROWS="reference train" measures these.
ROWS ?=
UPDATE ?=
speed: $(READY)
	$(BIN)/python -m benchmarks.speed $(if $(UPDATE),--update) $(ROWS)

# What commands cost, against the imports that they cannot do without.
cost: $(READY)
	$(BIN)/python -m benchmarks.cost

# This checkout against another, alternately: make against OLD=../earlier; NUMPY=1 without the compiled kernels.
against: $(READY)
	$(BIN)/python -m benchmarks.against $(if $(NUMPY),--numpy) $(OLD)

# A profile of 500 km and a train of sixteen coaches over ten kilometres: time and memory.
scale: $(READY)
	$(BIN)/python -m benchmarks.profiles
	$(BIN)/python -m benchmarks.train

# What it costs to share a sweep out among processes, or the workers of a cluster; on idle cores.
workers: $(READY)
	$(BIN)/python -m benchmarks.workers

# `kill -9` of client, worker and scheduler of a cluster, at ten random moments each.
kills: $(READY)
	$(BIN)/python -m benchmarks.kills

# Closed form against four hundred realisations.
random: $(READY)
	$(BIN)/python -m benchmarks.random_roads

# Thousands of damaged files for every reader of profiles.
fuzz: $(READY)
	$(BIN)/python -m tests.fuzz_readers

# Three hundred drawn cases, each against the same solved finer on a longer record; CASES=17 one of them alone.
CASES ?=
honest: $(READY)
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python -m tests.honest --jobs $(JOBS) $(addprefix --only ,$(CASES))

accuracy: $(READY)
	$(BIN)/python -m benchmarks.accuracy

# Deliberate faults: all of them, or one part alone (`make faults PART=response`). `make faults PART=?` says what each
# part covers.
PART ?=
faults: $(READY)
	$(BIN)/python -m tests.faults $(if $(filter ?,$(PART)),--parts,$(addprefix --part ,$(PART)))

# Calls between rooms, counted while the reference case runs and what is built on it; no call may lead back.
calls: $(READY)
	$(BIN)/python tools/calls.py

# Source distribution and wheel: built, checked, installed into an empty environment and used there.
dist: $(READY)
	PYTHON=$(PYTHON) tools/dist.sh

# The pictures of the documentation: rooms and their arrows, drawn from the imports; sampling; sweeps.
picture: $(READY)
	$(BIN)/python docs/images/rooms.py
	$(BIN)/python -W ignore docs/images/sampling.py
	$(BIN)/python -W ignore docs/images/sweeps.py

# An editable install, redone when the dependencies change. The mark is set last: an interrupted
# installation is taken up again.
$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "movingfrf needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "installing into $(VENV)"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(READY)

clean:
	rm -rf $(VENV) .venv-lowest .venv-newest build dist out
