# gearstudy: `make` lists what can be made. Every target does its own set-up.

SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

# rustup installs here; a shell opened before that does not know it.
export PATH := $(PATH):$(HOME)/.cargo/bin
# Tests that read results back with Python find it here, whatever their folder.
export GEARSTUDY_PYTHON := $(CURDIR)/.venv/bin/python

# The random cases of the tests are the same in every run; `cargo test` by itself draws new ones.
export PROPTEST_RNG_SEED := 20261121

# As `cargo clippy -- -D warnings` has it, for the crate itself in any build.
LINTED := RUSTC_WORKSPACE_WRAPPER=clippy-driver CLIPPY_ARGS=-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__

# What `make diff` compares the results folder with.
BASE ?= HEAD
RELEASE := target/release/gearstudy
STUDIES := $(sort $(wildcard studies/*.yaml))

.PHONY: help setup packages release studies study test bench bench-peers results diff dist dist-again dist-test clean

help:  ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

setup:  ## install what the machine lacks: Debian packages, Python tools for the cross-checks
	@scripts/setup

packages:
	@scripts/setup packages

release: packages  ## build the program with optimisation
	cargo build --release --locked

studies: release  ## run every study: tables, figures and reports in results/
	@status=0; for study in $(STUDIES); do $(RELEASE) run "$$study" || status=$$?; done; exit $$status

study: release  ## run one study: make study STUDY=energy_ga
	@if [ -z "$(STUDY)" ] || [ ! -f "studies/$(STUDY).yaml" ]; then \
		echo "make study STUDY=name, where name is one of: $(patsubst studies/%.yaml,%,$(STUDIES))" >&2; exit 2; fi
	$(RELEASE) run "studies/$(STUDY).yaml"

test: packages  ## format, lints, licences of crates, all tests, and the quick study run twice
	cargo fmt --all --check
	scripts/check-crates
	@# One build for lints and tests, benches too: a check of its own would build most of the dependencies again. What
	@# the cross-checks need of Python is installed meanwhile.
	scripts/setup & python=$$!; status=0; \
		$(LINTED) cargo test --locked --workspace --tests --benches --no-run || status=$$?; \
		wait $$python; exit $$status
	$(LINTED) cargo test --locked --workspace
	@# The program that the tests were built with: another build would differ in features and take a minute.
	scripts/run-twice target/debug/gearstudy studies/quick.yaml

bench: packages  ## measure the kernels and the program, and calls from Python beside the same in Rust
	cargo bench --locked
	cargo build --release --locked -p gearmesh --example timed
	scripts/setup
	scripts/setup dist
	PATH="$(CURDIR)/target/tools/python/bin:$$PATH" python/build --release
	.venv/bin/python python/bench

bench-peers: release  ## measure the runner beside make, ninja and, where they can be had, Snakemake, doit, DVC, redun
	scripts/setup peers
	scripts/bench-peers $(PEERS)

results: studies  ## refresh the results that are committed, and show what changed
	@git status --short results

diff: release  ## what changed in the results since a commit, and why: make diff BASE=main
	$(RELEASE) diff $(BASE)

dist:  ## build what is handed out, into target/dist: tarball, Debian package, wheel; docs/releasing.md
	nice scripts/dist

dist-again:  ## build it once more in another folder, and compare every byte
	nice scripts/dist again

dist-test:  ## install what `make dist` made in a bare Debian, and run a study there
	scripts/dist-test

clean:  ## remove what was built and the cache; studies and results stay
	rm -rf target .venv .gearstudy
