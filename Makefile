# `make` lists the targets. Variables: see CONTRIBUTING.md, "Settings of a build", and the lines of the
# targets.

SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DEFAULT_GOAL := help
MAKEFLAGS += --no-print-directory
# A build uses all cores; a test or a second build at the same time would only disturb it.
.NOTPARALLEL:

ifneq ($(findstring :,$(CURDIR)),)
  $(error The path $(CURDIR) has a colon, which separates the entries of PYTHONPATH. Rename the folder)
endif

# What each target reads. Another word with = after make would be ignored without a message.
book_READS := EXECUTED JOBS RELEASE RENDER SECOND SITE_URL SOLUTIONS
execute_READS := PAGE RENDER TO
evidence_READS := BACKEND LESSON TO
evidence-rocm_READS := LESSON
verify_READS := BUNDLE
test_READS := EXECUTED JOBS
test-all_READS := $(test_READS)
lesson_READS := NEW
compare_READS := NEW OLD REPORT
agree_READS := FIRST SECOND
serve_READS := PORT
live_READS := EXECUTE PORT RENDER SOLUTIONS
repin_READS := GENESIS JOBS RENDER SITE_URL SOLUTIONS
bench_READS := ROWS RUNS
$(foreach name,clean distclean help home-picture lint lock pages .venv/.installed,$(eval $(name)_READS :=))
ALWAYS := BASE_PYTHON PYTHON TORCH_INDEX
GOALS := $(or $(MAKECMDGOALS),help)
READ := $(sort $(ALWAYS) $(foreach goal,$(GOALS),$($(goal)_READS)))
SET := $(foreach name,$(sort $(foreach list,$(filter %_READS,$(.VARIABLES)),$($(list)))),$(if $($(name)),$(name)))
unread = $(strip $(foreach name,$(filter-out $(READ),$(2)),$(and $(filter $(1),$(firstword $(origin $(name)))),$(name))))
ifeq ($(filter undefined,$(foreach goal,$(GOALS),$(origin $(goal)_READS))),)
  ifneq ($(call unread,command,$(.VARIABLES)),)
    $(error make $(GOALS) does not read $(call unread,command,$(.VARIABLES)). It reads $(READ). \
      Write a setting of another program before make)
  endif
  ifneq ($(and $(filter 0,$(MAKELEVEL)),$(call unread,environment,$(SET))),)
    $(warning make $(GOALS) does not read $(call unread,environment,$(SET)), which the environment has)
  endif
endif
# A make below this one gets these variables as environment.
MAKEOVERRIDES :=

ifdef PYTHON
  PY := $(PYTHON)
  NAME := PYTHON=$(PYTHON)
  GIVE := Give the path of an interpreter with the packages of requirements.lock, or leave PYTHON out to use .venv.
  FILL := Install the lock there: pip install -r requirements.lock
  ENVIRONMENT := has-packages
else
  PY := .venv/bin/python
  NAME := $(PY)
  GIVE := The Python that made it was removed or replaced. Remove .venv; the same command then makes it again.
  FILL := Remove .venv; the same command then makes it again.
  ENVIRONMENT := .venv/.installed has-packages
endif
BASE_PYTHON ?= python3

# The code under test is this checkout's, whatever environment runs it.
export PYTHONPATH := $(CURDIR)
# Without plug-ins, no other installed package decides what pydantic accepts as evidence.
export PYDANTIC_DISABLE_PLUGINS := __all__
export RENDER ?= 1
export JOBS
export RELEASE
export BUNDLE
export GENESIS
export SITE_URL
export SOLUTIONS
export EXECUTED

.PHONY: help
help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /\1|/' | \
	  while IFS='|' read -r name text; do printf '  make %-13s %s\n' "$$name" "$$text"; done

.PHONY: book
book: $(ENVIRONMENT) ## measure every lesson on CPU, verify, render and check the site
	@"$(PY)" build_scripts/book.py

# PAGE and TO reach the script as environment variables.
.PHONY: execute
execute: $(ENVIRONMENT) ## execute one page and export it as files (PAGE=l04/lab TO=folder)
	@"$(PY)" build_scripts/execute.py

.PHONY: pages
pages: $(ENVIRONMENT) ## print the executed pages as JSON
	@"$(PY)" build_scripts/execute.py --list

# LESSON, BACKEND and TO reach the script as environment variables.
.PHONY: evidence
evidence: NEEDED = genesis jupyter_book
evidence: $(ENVIRONMENT) ## record all labs here, or one (BACKEND=amdgpu|cuda|cpu LESSON=l04 TO=folder)
	@"$(PY)" build_scripts/evidence.py

# The container has the packages; the host needs Python alone. LESSON reaches the script as an
# environment variable.
.PHONY: evidence-rocm
evidence-rocm: ## record all labs, or one, in a container with ROCm (LESSON=l04; docker or podman)
	@$(REQUIRE_BASE)
	@"$(BASE_PYTHON)" build_scripts/evidence_rocm.py

.PHONY: verify
verify: $(ENVIRONMENT) ## verify recorded and built evidence (BUNDLE=path: one folder)
	@"$(PY)" build_scripts/verify.py

# The site is built first, because the tests of the engine hold the lock of builds.
TESTS = echo "test  step 1 of 2, the site" && "$(PY)" build_scripts/book.py && \
  echo "test  step 2 of 2, the tests" && "$(PY)" -m pytest --numprocesses 2 --dist loadscope --no-loadscope-reorder

.PHONY: test
test: export RENDER = 1
test: export SITE_URL =
test: export SOLUTIONS =
test: export RELEASE =
test: $(ENVIRONMENT) ## build the site, and run the tests (needs Debian's chromium)
	@$(TESTS)

.PHONY: test-all
test-all: export RENDER = 1
test-all: export SITE_URL =
test-all: export SOLUTIONS =
test-all: export RELEASE =
test-all: $(ENVIRONMENT) ## run the slow tests too: empty environments, a changed pin (network; hours)
	@$(TESTS) --slow

# codespell looks up what its expression finds: here the entries of our list, phrases included. It
# leaves out names of files and attributes, "there is no", "is no longer" and "stand still".
WORDS = (?<![./-])(?<!here )(?:$$(sed 's/->.*//; s/^[a-z]/\\b[&\U&]/' .words.txt | sort -r | paste -sd '|'))\b(?! longer| more| still|[.]\w)
# codespell reads a hidden folder only if the names that it gets are inside.
PROSE := book robo_genesis build_scripts *.md LICENSE pyproject.toml .ci/* .github/* .rocm/*

.PHONY: lint
lint: $(ENVIRONMENT) ## ruff, mypy, import contracts, codespell, sizes and typed numbers of pages, schemas of .github
	@"$(PY)" -m ruff check .
	@"$(PY)" -m ruff format --check .
	@"$(PY)" -m mypy
	@"$(PY)" -c 'from importlinter.cli import lint_imports_command; lint_imports_command()' --no-logo --no-cache
	@"$(PY)" -m codespell_lib
	@"$(PY)" -m codespell_lib --dictionary .words.txt --regex "$(WORDS)" $(PROSE)
	@"$(PY)" build_scripts/sizes.py
	@"$(PY)" -m pytest -q -p no:cacheprovider tests/lessons/test_prose.py
	@"$(PY)" -m check_jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml
	@"$(PY)" -m check_jsonschema --builtin-schema vendor.github-actions .github/actions/*/action.yml
	@"$(PY)" -m check_jsonschema --builtin-schema vendor.dependabot .github/dependabot.yml
	@"$(PY)" -m check_jsonschema --builtin-schema vendor.github-issue-forms .github/ISSUE_TEMPLATE/*.yml

# NEW reaches the script as an environment variable.
.PHONY: lesson
lesson: $(ENVIRONMENT) ## add a lesson that is made from the template (NEW=l07)
	@"$(PY)" build_scripts/lesson.py

# OLD and NEW reach the recipe through the environment, so a path may hold any character.
.PHONY: compare
compare: $(ENVIRONMENT) ## compare two bundles: OLD=path NEW=path [REPORT=folder]
	@"$(PY)" build_scripts/compare.py --report "$${REPORT:-}" -- "$${OLD:-}" "$${NEW:-}"

# FIRST and SECOND reach the script as environment variables.
.PHONY: agree
agree: $(ENVIRONMENT) ## require that two executions agree (FIRST=folder SECOND=folder, each from make execute)
	@"$(PY)" build_scripts/agree.py

.PHONY: home-picture
home-picture: ## renew the README's picture from the built site (needs Debian's chromium)
	@test -f book/_build/html/index.html || { echo "There is no site. Build it: make book" >&2; exit 1; }
	@chromium --headless --no-sandbox --hide-scrollbars --window-size=1280,900 --virtual-time-budget=5000 \
	  --screenshot="$(CURDIR)/.github/home.png" "file://$(CURDIR)/book/_build/html/index.html"

.PHONY: serve
serve: $(ENVIRONMENT) ## serve the built site on localhost (PORT=8000)
	@"$(PY)" build_scripts/serve.py

# PORT and EXECUTE reach the script as environment variables.
.PHONY: live
live: $(ENVIRONMENT) ## show the book on localhost while it is written (PORT=8000 EXECUTE=1)
	@"$(PY)" build_scripts/live.py

.PHONY: clean
clean: ## remove the built site and the executed pages, keep the compiled kernels
	@rm -rf book/_build book/._build.* .cache/pages .cache/render .cache/live .cache/derived .cache/release .pytest_cache .mypy_cache .ruff_cache .hypothesis

.PHONY: distclean
distclean: clean ## remove the environment and every cache too
	@test ! -e .venv || test -e .venv/.robo-genesis || test -e .venv/.installed || { \
	  echo ".venv was not made by make, so it stays. Move it away" >&2; exit 1; }
	@rm -rf .venv .cache

.PHONY: lock
lock: $(ENVIRONMENT) ## resolve requirements.lock again from pyproject.toml
	@"$(PY)" build_scripts/lock.py

# GENESIS reaches the script as an environment variable.
.PHONY: repin
repin: $(ENVIRONMENT) ## try another engine version, then change pin and lock (GENESIS=version)
	@"$(PY)" build_scripts/repin.py

# ROWS and RUNS reach the script as environment variables.
.PHONY: bench
bench: $(ENVIRONMENT) ## measure whole commands against bare counterparts (ROWS=names RUNS=n; a quiet machine)
	@"$(PY)" build_scripts/bench.py

# Packages by the names of their modules; recording needs no linter and no test.
NEEDED = genesis jupyter_book pytest xdist ruff mypy importlinter codespell_lib check_jsonschema

.PHONY: has-packages
has-packages:
	@missing=$$("$(PY)" -c 'from importlib.util import find_spec; \
	  print(*(name for name in "$(NEEDED)".split() if find_spec(name) is None), sep=", ")' 2>/dev/null) || { \
	  echo "$(NAME) is not a Python command. $(GIVE)" >&2; exit 1; }; test -z "$$missing" || { \
	  echo "$(NAME) lacks $$missing. $(FILL)" >&2; exit 1; }

REQUIRE_BASE = "$(BASE_PYTHON)" -c 'import sys; 1 / ((3, 11) <= sys.version_info[:2] < (3, 14))' 2>/dev/null || { \
  echo "BASE_PYTHON=$(BASE_PYTHON) is not a command of Python 3.11, 3.12 or 3.13. Give the path of one of them." \
  "On Debian: apt install python3-venv" >&2; exit 1; }

# The address of Torch's builds for the CPU has one home, where the site's commands for students read it.
.venv/.installed: requirements.lock
	@$(REQUIRE_BASE)
	@TORCH_INDEX="$${TORCH_INDEX:-$$(sed -n 's/^ *torch_index: *\([^ ]*\).*/\1/p' book/_config.yml)}" \
	  "$(BASE_PYTHON)" build_scripts/install.py
