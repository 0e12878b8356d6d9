# Two commands for a stranger: `make demo` and `make test`. Both do all their set-up in .venv.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin

.PHONY: demo lowest alone test peers pure links compiled wheel stress steady fuzz life rows chaos soak check bench pictures macos windows clean
.NOTPARALLEL:

# Tests start many programs; each would compile all of yarpy anew.
unexport PYTHONDONTWRITEBYTECODE

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

# What needs no foreign program, the same wherever it runs; `peers` is the rest. Most tests wait for
# something, so there are more workers than processors.
WORKERS ?= 6
PYTEST = $(BIN)/python tests/support/warm.py $(STAGE) && $(BIN)/python -m pytest -n $(WORKERS) --dist worksteal
test: $(VENV)/.ready
	$(PYTEST) -m "not peer"

# Beside C++ YARP, ROS, browsers and others; -rs says what is missing and how to get it.
peers: $(VENV)/.ready
	$(PYTEST) -m peer -rfEs

pure links: STAGE = $@
pure links: $(VENV)/.ready
	$(PYTEST) -m "not peer" --stage $(STAGE)

# The core in a copy without any guest or kit; GUESTS="zenoh ros" deletes one after another.
alone: $(VENV)/.ready
	$(BIN)/python tests/support/alone.py -n$(WORKERS) $(GUESTS)

# With the oldest version that each library may have.
lowest:
	$(PYTHON) -m venv .venv-lowest
	.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check \
	    $$($(PYTHON) tests/support/lowest.py) pytest pytest-timeout hypothesis
	.venv-lowest/bin/python -m pip install --quiet --disable-pip-version-check --no-deps -e .
	.venv-lowest/bin/python -m pytest -m "not peer" tests/wire tests/data tests/carriers \
	    tests/cli/test_main.py tests/cli/test_completion.py

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
	$(COMPILED) $(BIN)/python -m pytest -n $(WORKERS) --dist worksteal -m "not peer" $(TESTS)

# TIMES in a row, and the same beside a busy loop for each processor: no test may fail in any run.
TIMES ?= 5
steady: $(VENV)/.ready
	for run in $$(seq $(TIMES)); do echo "run $$run of $(TIMES)"; $(MAKE) --no-print-directory test || exit; done

stress: $(VENV)/.ready
	$(BIN)/python tests/support/busy.py $(MAKE) --no-print-directory steady TIMES=$(TIMES)

# Kills, stops and lies for ten minutes, and the table of docs/reliability.md.
chaos: $(VENV)/.ready
	$(BIN)/python tests/chaos/run.py

# How long `soak`, `fuzz` and `life` take; hours find more.
SECONDS ?= 3600

# Whether memory and descriptors stay what they are.
soak: $(VENV)/.ready
	$(BIN)/python tests/chaos/soak.py $(SECONDS)

# PLW1514: text files are opened with an encoding, since that of Windows is none that files have.
check: $(VENV)/.ready
	$(BIN)/ruff check .
	$(BIN)/ruff check --preview --select PLW1514 .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/mypy --platform darwin --cache-dir .mypy_cache/darwin
	$(BIN)/mypy --platform win32 --cache-dir .mypy_cache/win32
	$(BIN)/python tests/support/breaking.py

# Strange input for everything that reads. SEED=N does a run again.
fuzz: $(VENV)/.ready
	$(BIN)/python tests/fuzz/run.py $(SECONDS) $(if $(SEED),--seed $(SEED))

# Random programs that open, write, call, interrupt, cancel, fork and end. SEED=N begins with that one.
life: $(VENV)/.ready
	$(BIN)/python tests/life/property.py $(SECONDS) $(if $(SEED),--seed $(SEED))

# Tests of bytes, links, ports and names that see macOS where Linux is.
macos: $(VENV)/.ready
	for stage in pure links; do YARPY_TESTS_AS=darwin PYTHONPATH=tests $(BIN)/python -m pytest \
	    -p support.darwin -n $(WORKERS) --dist worksteal -m "not peer" --stage $$stage || exit; done

# The README's program, tests of bytes, links, names, ports, commands, recordings, applications with the
# Python of Windows, under wine, and what meets C++ YARP and a browser of Linux there; PATHS="tests/cli"
# runs others, PATHS=quick those that take a few minutes.
windows: $(VENV)/.ready
	$(BIN)/python tests/support/windows.py $(PATHS)

# What the pages look like, for README and docs; needs Chromium.
pictures: $(VENV)/.ready
	YARPY_PICTURES=docs/pictures $(BIN)/python -m pytest -q tests/interop/test_pictures.py

# Each promise about starting, interrupting, cancelling, ending: 20 times on one core beside a busy
# loop. ROW=asyncio takes one of them; `python tests/life/rows.py` names them.
ROW ?= all
rows: $(VENV)/.ready
	$(BIN)/python tests/life/rows.py $(ROW) 20

bench: $(VENV)/.ready
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -e '.[bench]'
	$(BIN)/python bench/run.py

clean:
	rm -rf $(VENV) dist build .pytest_cache .mypy_cache .ruff_cache .hypothesis
