# `make` lists the targets. CONTRIBUTING.md explains them and their settings.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory
# A build uses all cores; a test or a second build at the same time would only disturb it.
.NOTPARALLEL:

BASE_PYTHON ?= python3
PYTHON ?= .venv/bin/python
# Another interpreter has the packages of requirements.lock already.
ENVIRONMENT := $(if $(filter .venv/bin/python,$(PYTHON)),.venv/.installed)
COURSE = "$(PYTHON)" -m robo_genesis
# $(call options,JOBS SITE_URL) is --jobs=… --site-url=…, each if it is given.
options = $(foreach name,$(1),$(if $($(name)),--$(shell tr A-Z_ a-z- <<< $(name))="$$$(name)"))

# The code under test is this checkout's, whatever environment runs it.
export PYTHONPATH := $(CURDIR)
# A build starts some fifty processes: each would compile all modules of the engine again. The claims
# of checks are docstrings, which the second removes.
unexport PYTHONDONTWRITEBYTECODE PYTHONOPTIMIZE

.PHONY: help book execute evidence evidence-rocm verify compare test test-all lint lesson serve live \
  home-picture lock repin clean distclean
help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' Makefile

book: $(ENVIRONMENT) ## measure every lesson on CPU, verify, render and check the site
	@$(COURSE) book $(call options,JOBS RELEASE RENDER SITE_URL SOLUTIONS)

execute: $(ENVIRONMENT) ## execute one page (PAGE=l04/lab)
	@$(COURSE) execute $(call options,RENDER) "$(PAGE)"

evidence: $(ENVIRONMENT) ## record all labs here, or one (BACKEND=amdgpu|cuda|cpu LESSON=l04 TO=folder)
	@$(COURSE) evidence $(call options,BACKEND LESSON TO)

evidence-rocm: ## record all labs, or one, in a container with ROCm (LESSON=l04; docker or podman)
	@"$(BASE_PYTHON)" -m robo_genesis evidence-rocm $(call options,LESSON)

verify: $(ENVIRONMENT) ## verify recorded and built evidence (BUNDLE=path: one folder)
	@$(COURSE) verify $(call options,BUNDLE)

compare: $(ENVIRONMENT) ## compare two bundles: OLD=path NEW=path [REPORT=folder]
	@$(COURSE) compare $(call options,REPORT) "$(OLD)" "$(NEW)"

# The site is built first, because the tests of the engine hold the lock of builds.
TESTS = $(COURSE) book $(call options,JOBS) && \
  "$(PYTHON)" -m pytest --numprocesses 3 --dist loadscope --no-loadscope-reorder
test: $(ENVIRONMENT) ## build the site, and run the tests (needs Debian's chromium)
	@$(TESTS)

test-all: $(ENVIRONMENT) ## run the slow tests too: empty environments (network; hours)
	@$(TESTS) --slow

# codespell looks up what its expression finds: here the entries of our list, phrases included. It
# leaves out names of files and attributes, "there is no", "is no longer" and "stand still".
WORDS = (?<![./-])(?<!here )(?:$$(sed 's/->.*//; s/^[a-z]/\\b[&\U&]/' .words.txt | sort -r | paste -sd '|'))\b(?! longer| more| still|[.]\w)
# codespell reads a hidden folder only if the names that it gets are inside.
PROSE := book robo_genesis build_scripts *.md LICENSE pyproject.toml .ci/* .github/* .rocm/*
SCHEMA = @"$(PYTHON)" -m check_jsonschema --builtin-schema vendor
lint: $(ENVIRONMENT) ## ruff, mypy, import contracts, codespell, marks of merges, sizes and typed numbers of pages, schemas of .github
	@"$(PYTHON)" -m ruff check .
	@"$(PYTHON)" -m ruff format --check .
	@"$(PYTHON)" -m mypy
	@"$(PYTHON)" -c 'from importlinter.cli import lint_imports_command; lint_imports_command()' --no-logo --no-cache
	@"$(PYTHON)" -m codespell_lib
	@! git grep --line-number --extended-regexp '^(<{7}|>{7}) '
	@"$(PYTHON)" -m codespell_lib --dictionary .words.txt --regex "$(WORDS)" $(PROSE)
	@$(COURSE) sizes
	@"$(PYTHON)" -m pytest -q -p no:cacheprovider tests/lessons/test_prose.py
	$(SCHEMA).github-workflows .github/workflows/*.yml
	$(SCHEMA).github-actions .github/actions/*/action.yml
	$(SCHEMA).dependabot .github/dependabot.yml
	$(SCHEMA).github-issue-forms .github/ISSUE_TEMPLATE/*.yml

lesson: $(ENVIRONMENT) ## add a lesson that is made from the template (NEW=l99)
	@$(COURSE) lesson "$(NEW)"

serve: $(ENVIRONMENT) ## serve the built site on localhost (PORT=8000)
	@test -f book/_build/html/index.html || { echo "There is nothing to serve yet. Run make book first."; exit 1; }
	@"$(PYTHON)" -m http.server --bind 127.0.0.1 --directory book/_build/html $(PORT)

live: $(ENVIRONMENT) ## show the book on localhost while it is written (PORT=8000)
	@$(COURSE) live $(call options,PORT RENDER SOLUTIONS)

home-picture: ## renew the README's picture from the built site (needs Debian's chromium)
	@chromium --headless --no-sandbox --hide-scrollbars --window-size=1280,900 --virtual-time-budget=5000 \
	  --screenshot="$(CURDIR)/.github/home.png" "file://$(CURDIR)/book/_build/html/index.html"

lock: $(ENVIRONMENT) ## resolve requirements.lock again from pyproject.toml (UPGRADE=package)
	@$(COURSE) lock $(call options,UPGRADE)

repin: $(ENVIRONMENT) ## try another engine version, then change pin and lock (GENESIS=version)
	@$(COURSE) repin "$(GENESIS)"

clean: ## remove the built site and the executed pages, keep the compiled kernels
	@rm -rf book/_build book/._build.* .cache/{pages,render,live,derived,release,repin} .{pytest,mypy,ruff}_cache .hypothesis

distclean: clean ## remove the environment and every cache too
	@rm -rf .venv .cache

.venv/.installed: requirements.lock
	@"$(BASE_PYTHON)" -m robo_genesis.maintain.environment
	@touch $@
