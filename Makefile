# `make demo` and `make test` need Python 3.11 or newer, pip and make, and nothing else.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
SCENARIO := out/demo.toml

.PHONY: demo paper test bench scale random fuzz accuracy faults lint format clean

demo: $(READY)
	@mkdir -p out
	@$(BIN)/movingfrf new $(SCENARIO) --force
	@$(BIN)/movingfrf run $(SCENARIO) --output out/demo

paper: $(READY)
	$(BIN)/movingfrf paper --output out/paper

test: $(READY) lint
	$(BIN)/pytest -q

lint: $(READY)
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(READY)
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(READY)
	$(BIN)/python -m benchmarks.bench

# A profile of 500 km and a train of sixteen coaches over ten kilometres: time and memory.
scale: $(READY)
	$(BIN)/python -m benchmarks.profiles
	$(BIN)/python -m benchmarks.train

# Closed form against four hundred realisations.
random: $(READY)
	$(BIN)/python -m benchmarks.random_roads

# Thousands of damaged files for every reader of profiles.
fuzz: $(READY)
	$(BIN)/python -m tests.fuzz_readers

accuracy: $(READY)
	$(BIN)/python -m benchmarks.accuracy

faults: $(READY)
	$(BIN)/python -m tests.faults

# An editable install, redone when the dependencies change. The mark is set last: an interrupted
# installation is taken up again.
$(READY): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "movingfrf needs Python 3.11 or newer: make PYTHON=python3.11 ...")'
	@test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	@echo "installing into $(VENV)"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(READY)

clean:
	rm -rf $(VENV) out
