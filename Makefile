# Everything from a fresh checkout with Python 3.11+, a shell and make:
#   make serve   the editor and the service on http://127.0.0.1:8000/, with an example open
#   make test    every check and every test, the browser's too
#   make bench   what the README's numbers come from; about three quarters of an hour
#   make lock    the lock files anew, from pyproject.toml

PYTHON ?= python3
HOST ?= 127.0.0.1
PORT ?= 8000
# Arguments for pytest, as in: make test PYTEST='tests/cli -x'
PYTEST ?= -n 2 --dist loadfile

VENV := .venv
BIN := $(VENV)/bin
STAMPS := $(VENV)/.stamps
PIP := $(BIN)/python -m pip install -qq --disable-pip-version-check
export PATH := $(CURDIR)/$(BIN):$(PATH)

PAGE_SOURCES := $(shell find web -type d \( -name node_modules -o -name dist \) -prune -o -type f \
	\( -path 'web/src/*' -o -path 'web/public/*' -o -name '*.html' -o -name '*.config.*' -o -name 'tsconfig*.json' \
	-o -name package.json \) -print 2>/dev/null)
ifneq ($(wildcard web/package.json),)
PAGE := web/dist/index.html
CHECK_PAGE := check-page
endif

.PHONY: serve test check check-page bench lock clean
.DELETE_ON_ERROR:

serve: $(STAMPS)/install $(PAGE)
	$(BIN)/intaglio serve --host $(HOST) --port $(PORT)

# The kernels are compiled once beforehand, not by each of pytest's processes. pytest comes last: its summary is the
# last line.
test: check $(CHECK_PAGE) $(PAGE) $(STAMPS)/chromium
	$(BIN)/python -c 'from renderer.pipeline import warm_up; warm_up(lines=True, geometry=True, textures=True, meshes=True)'
	$(BIN)/python -m pytest $(PYTEST)

bench: $(STAMPS)/dev
	$(BIN)/python -m bench

check: $(STAMPS)/dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

# package.json's scripts: `types` (TypeScript's types from openapi.json), `check` (tsc), `test`, `build`.
check-page: $(STAMPS)/page web/openapi.json
	cd web && npm run --silent --if-present types && npm run --silent --if-present check \
		&& npm run --silent --if-present test

$(PAGE): $(STAMPS)/page web/openapi.json $(PAGE_SOURCES)
	cd web && npm run --silent --if-present types && npm run --silent build
	@touch $@

web/openapi.json: $(STAMPS)/install $(wildcard service/*.py schema/*.py)
	$(BIN)/python -m service.openapi > $@

$(STAMPS)/venv:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Python 3.11 or newer is needed: make PYTHON=/path/to/python3.11 ..." >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	@mkdir -p $(STAMPS) && touch $@

$(STAMPS)/runtime: requirements/runtime.txt | $(STAMPS)/venv
	$(PIP) --require-hashes -r $<
	@touch $@

$(STAMPS)/install: pyproject.toml $(STAMPS)/runtime
	$(PIP) --no-build-isolation --no-deps --editable .
	@touch $@

$(STAMPS)/dev: requirements/dev.txt $(STAMPS)/install
	$(PIP) --require-hashes -r $<
	@touch $@

# The system's node where it is new enough, otherwise the one that comes as a Python package.
$(STAMPS)/node: requirements/node.txt | $(STAMPS)/venv
	@if node -e 'process.exit(parseInt(process.versions.node) < 20 ? 1 : 0)' 2>/dev/null && npm --version >/dev/null 2>&1; \
		then :; else echo "no node 20 here: installing it into $(VENV)"; $(PIP) --require-hashes -r $<; fi
	@touch $@

$(STAMPS)/page: web/package.json web/package-lock.json .npmrc $(STAMPS)/node
	cd web && npm ci --userconfig ../.npmrc --no-audit --no-fund
	@touch $@

# The system's Chromium, or the system's package, or Playwright's own.
$(STAMPS)/chromium: $(STAMPS)/dev
	@if command -v chromium >/dev/null || command -v chromium-browser >/dev/null || command -v google-chrome >/dev/null; \
		then :; \
	elif [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && apt-get update -qq && \
		DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends chromium >/dev/null; then :; \
	else $(BIN)/playwright install chromium; fi
	@touch $@

# No registry's address gets into these files.
UV := $(BIN)/uv pip compile --universal --python-version 3.11 --generate-hashes --no-emit-index-url --no-header --quiet
lock: | $(STAMPS)/venv
	$(PIP) uv
	$(UV) pyproject.toml --group build -o requirements/runtime.txt $(LOCK)
	$(UV) --group dev -c requirements/runtime.txt -o requirements/dev.txt $(LOCK)
	$(UV) --group node -o requirements/node.txt $(LOCK)

clean:
	rm -rf $(VENV) web/node_modules web/dist
