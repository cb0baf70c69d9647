# Two commands do everything on a fresh machine: `make demo` and `make test`.
# The environment is .venv in this folder, built from pyproject.toml and constraints.txt.

PYTHON ?= $(shell for name in python3.11 python3.10 python3; do if $$name -c "" 2>/dev/null; then echo $$name; break; fi; done)
BIN := .venv/bin
export NUMBA_CACHE_DIR := $(CURDIR)/.venv/numba-cache

.PHONY: demo tables sensitivity test test-slow stress check format bench clean

demo: .venv/installed
	$(BIN)/adhoc run -m policy=none,idle,heuristic,irot join_step=0,50 benchmark=demo out=demo
	$(BIN)/adhoc report demo --markdown demo/table.md --html demo/report.html
	$(BIN)/adhoc inspect demo corridor-s0--heuristic--irot-offline--t0 --out demo/episode.html

# The paper's tables and its ablation, complete, on 30 tasks with the offline model: about half an hour.
tables: .venv/installed
	$(BIN)/adhoc run experiment=all_tables benchmark=sample workers=2 out=tables
	$(BIN)/adhoc run experiment=ablation benchmark=sample workers=2 out=tables
	$(BIN)/adhoc report tables --intervals --markdown tables/tables.md --html tables/tables.html --figures tables/figures

# How the order of the planners depends on how often the offline model errs: about a quarter of an hour.
sensitivity: .venv/installed
	$(BIN)/adhoc sensitivity --out sensitivity workers=2

# In so many processes at a time.
JOBS ?= 2
test: .venv/installed-dev
	$(BIN)/pytest -n $(JOBS)

test-slow: .venv/installed-dev
	$(BIN)/pytest -m slow

# Kills runs and their workers some hundred times: about a quarter of an hour.
stress: .venv/installed-dev
	$(BIN)/pytest -m stress tests/stress

check: .venv/installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/codespell

format: .venv/installed-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# A larger house than the shipped ones: make bench HOUSE=house.json.gz
bench: .venv/installed-dev
	$(BIN)/python benchmarks/speed.py $(HOUSE)
	$(BIN)/python benchmarks/episode.py $(HOUSE)
	$(BIN)/python benchmarks/decisions.py
	$(BIN)/python benchmarks/inspector.py
	$(BIN)/python benchmarks/interval_coverage.py
	$(BIN)/python benchmarks/other_intervals.py
	$(BIN)/python benchmarks/dataset.py
	$(BIN)/python benchmarks/ledger.py
	$(BIN)/python benchmarks/workers.py
	$(BIN)/python benchmarks/runs.py
	$(BIN)/python benchmarks/report.py

.venv/bin/pip:
	$(PYTHON) -m venv .venv

.venv/installed: pyproject.toml constraints.txt | .venv/bin/pip
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable .
	touch $@

.venv/installed-dev: pyproject.toml constraints.txt | .venv/bin/pip
	$(BIN)/pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable ".[dev]"
	touch $@ .venv/installed

clean:
	rm -rf .venv demo tables sensitivity out build dist
