# make demo    build everything into .venv and run the main example
# make test    every test, Rust and Python
# make lint    formatting, lints, types and documentation, warnings denied
# make docs    the documentation site, into target/docs, and its examples
# make bench   criterion benchmarks
# make bench-peers     run time against error beside AUTO-07p and scipy (apt-get install auto-07p gfortran)
# make bench-figures   error against time and scaling, measured and drawn, into docs/figures
# make bench-guard     instructions of units of work against stored numbers; needs valgrind
# make stress          extreme input, 10,000 random scenes, kills and interrupts: half an hour (docs/stress.md)
# make clean   remove what was built
#
# The environment is rebuilt only when Cargo.toml, Cargo.lock, pyproject.toml or a Rust source changes.

PYTHON ?= python3
BIN := .venv/bin
RUST_SOURCES := $(shell find src -name '*.rs')

# pyo3 builds against the environment's interpreter in every step, so that build artefacts are shared.
export PYO3_PYTHON := $(CURDIR)/$(BIN)/python
export VIRTUAL_ENV := $(CURDIR)/.venv
# maturin refuses two active environments.
unexport CONDA_PREFIX

.PHONY: venv develop demo test lint docs bench bench-peers bench-figures bench-guard stress clean

venv: .venv/.tools
develop: .venv/.develop

.venv/.tools:
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet 'maturin>=1.9,<2'
	touch $@

# Installs the package with its test and lint tools; the Python sources are linked, not copied.
.venv/.develop: .venv/.tools pyproject.toml Cargo.toml Cargo.lock $(RUST_SOURCES)
	$(BIN)/maturin develop --release --extras test,lint
	touch $@

demo: develop
	$(BIN)/ribbonrs run examples/helical_leaf.toml

# The Python tests on all cores, one thread of linear algebra on each.
test: develop
	cargo test --release
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --numprocesses auto

# All Rust steps here share one set of checked dependencies, that with the python feature, and procedural macros with the extension.
lint: develop
	cargo fmt --check
	cargo clippy --release --all-targets --features python -- -D warnings
	RUSTDOCFLAGS='-D warnings' cargo doc --release --no-deps --features python
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy
	$(BIN)/python -m mypy.stubtest ribbonrs._core

# The same installation once more, with the tools of the site.
.venv/.docs: .venv/.develop
	$(BIN)/maturin develop --release --extras docs
	touch $@

# -E: pages also change with docstrings.
docs: .venv/.docs
	$(BIN)/python -m pytest tests/python/test_pages.py tests/python/test_docstrings.py
	$(BIN)/python -m sphinx -E -W --keep-going -b html docs target/docs

bench:
	cargo bench

# One thread for all.
bench-peers: develop
	OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 RAYON_NUM_THREADS=1 $(BIN)/python benches/peers/run.py

# One thread, but where scaling.py says otherwise.
bench-figures: develop
	for work in work_section work_frame work_boundary scaling; do \
	  RAYON_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 $(BIN)/python docs/figures/$$work.py || exit 1; done

bench-guard: venv
	$(BIN)/python benches/guard.py

# SCENES=300 for fewer; the table of scenes is resumed where it was left.
SCENES ?= 10000
stress: develop
	mkdir -p target
	PYTHONPATH=tests/python $(BIN)/python -m stress $(SCENES) target/scenes.csv

clean:
	cargo clean
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .hypothesis python/ribbonrs/_core*.so
