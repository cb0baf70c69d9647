# Two commands do everything on a fresh machine: `make demo` and `make test`.
# The environment is .venv in this folder, built from pyproject.toml and constraints.txt.

PYTHON ?= $(shell for name in python3.11 python3.10 python3; do if $$name -c "" 2>/dev/null; then echo $$name; break; fi; done)
BIN := .venv/bin
export NUMBA_CACHE_DIR := $(CURDIR)/.venv/numba-cache

.PHONY: demo tables sensitivity test test-slow stress check format bench clean

demo: .venv/installed
	$(BIN)/adhoc run -m policy=none,heuristic,irot join_step=0,50 benchmark=demo out=demo
	$(BIN)/adhoc report demo --markdown demo/table.md

# The paper's tables and its ablation, complete, on 30 tasks with the offline model: about half an hour.
SWEEP := benchmark=sample join_step=0,50,100 workers=2 pictures=false transcript=false out=tables
ABLATIONS := no_subtask_planner,irot_no_evaluation_no_reflection,irot_no_evaluation,irot_no_reflection
tables: .venv/installed
	$(BIN)/adhoc run -m $(SWEEP) team=heuristic,learned,llm policy=none,random,heuristic,plastic,naive,gpl,cot,irot
	$(BIN)/adhoc run -m $(SWEEP) team=llm policy=$(ABLATIONS)
	$(BIN)/adhoc report tables --intervals --markdown tables/tables.md

# How the order of the planners depends on how often the offline model errs: about a quarter of an hour.
sensitivity: .venv/installed
	$(BIN)/adhoc sensitivity --out sensitivity workers=2

test: .venv/installed-dev
	$(BIN)/pytest

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
	$(BIN)/python benchmarks/dataset.py
	$(BIN)/python benchmarks/ledger.py
	$(BIN)/python benchmarks/workers.py

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
