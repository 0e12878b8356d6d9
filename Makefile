# Two commands for a stranger: `make demo` and `make test`. Both do all their set-up in .venv.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: demo test pure links programs compiled wheel stress fuzz chaos soak check bench clean
.NOTPARALLEL: # the stages, in their order

# What yarpy itself needs, told while it comes.
$(VENV)/.base: pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11) and "yarpy needs Python 3.11 or newer: make PYTHON=/path/to/python3.11")'
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --disable-pip-version-check -e .
	@touch $@

# The tests also use `import yarp` and the classical commands; neither comes with yarpy itself.
$(VENV)/.ready: $(VENV)/.base compat/pyproject.toml
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[test]' -e ./compat
	@touch $@

# This computer alone reaches it; make demo DEMO=--lan lets others of the network see and move it.
demo: $(VENV)/.base
	$(BIN)/yarpy demo $(DEMO)

# Some at a time, each with whole files: most tests wait for something. What is quick comes first, so
# that a mistake in it is known within a minute.
WORKERS ?= 2
PYTEST := $(BIN)/python -m pytest -n $(WORKERS) --dist loadfile
test: pure links programs

pure links programs: $(VENV)/.ready
	$(PYTEST) --stage $@

# Two wheels: pure Python, and one with a compiled core for this Python and computer.
wheel: $(VENV)/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[build]'
	$(BIN)/python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .
	YARPY_COMPILE=1 $(BIN)/python -m pip wheel --quiet --no-deps --no-build-isolation --wheel-dir dist .
	@ls dist

# The tests of what is compiled, with the compiled one in place of the sources; TESTS=tests takes all.
TESTS ?= tests/wire tests/data tests/link
COMPILED := PYTHONPATH=$(CURDIR)/build/compiled
compiled: wheel
	rm -rf build/compiled
	$(BIN)/python -m pip install --quiet --no-deps --no-index --find-links dist --target build/compiled yarpy
	$(COMPILED) $(BIN)/python tests/support/build.py
	$(COMPILED) $(PYTEST) $(TESTS)

# The same on a loaded machine, with the patience that this takes.
stress: $(VENV)/.ready
	YARPY_TEST_PATIENCE=4 $(BIN)/python tests/support/busy.py $(MAKE) test

# Kills, stops and lies for ten minutes, and the table of docs/reliability.md.
chaos: $(VENV)/.ready
	$(BIN)/python tests/chaos/run.py

# How long `soak` and `fuzz` take; hours find more.
SECONDS ?= 3600

# Whether memory and descriptors stay what they are.
soak: $(VENV)/.ready
	$(BIN)/python tests/chaos/soak.py $(SECONDS)

check: $(VENV)/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

# Strange input for everything that reads. SEED=N does a run again.
fuzz: $(VENV)/.ready
	$(BIN)/python tests/fuzz/run.py $(SECONDS) $(if $(SEED),--seed $(SEED))

bench: $(VENV)/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[bench]'
	$(BIN)/python bench/run.py

clean:
	rm -rf $(VENV) dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis
