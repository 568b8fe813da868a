# make test      installs what is missing and runs every check
# make setup     only the installation, into target/python-tools; no root where there is Python 3.12 or later
# make report    the report of the shipped scenes, into reports/
# make live-page the models for live pages, compiled to WebAssembly, into the program (with rustup)
# make wheel    the Python package, into target/wheels, and a clean environment with it: target/wheel-python
# make solutions computes the stored references of the shipped scenes again
# make validation  solves the random scenes that the table of predictions lacks: hours; goes on where it was stopped
#                (SHARD=2/4: the second of four machines, whose rows are then joined by validation/table.py; LONGEST=600: scenes
#                that take longer than these seconds wait)
# make evidence  slow evidence: references of all scenes and the truth of their bands, model C on the validation scenes,
#                studies, run time against error, random impacts, killed runs, FEniCSx's releases (an hour or more; the last
#                needs root)

# the environment that .ci/setup makes, with FEniCSx and what the checks need
VENV   := target/python-tools
TOOL   := $(VENV)/bin/python
PYTHON := $(or $(IMPACTCHECK_PYTHON),$(TOOL))
WHEEL  := target/wheel-python
# a program built before a change, that `make evidence` is to hold this one's instructions against
BEFORE :=
RUN    := cargo run --release --quiet --
OUT    := target/check
# the checks that need what only root installs; without it the last line says so, and CI fails
BROWSER  = $(or $(CHROMIUM),$(shell command -v chromium || command -v chromium-browser || command -v google-chrome))
UNCHECKED = $(if $(BROWSER)$(CI),,browser::)
CCX       = $(shell command -v $(or $(IMPACTCHECK_CCX),ccx) 2>/dev/null)
LEFT_OUT  = $(if $(CCX)$(CI),, and not calculix)
# the Python package, as it is installed
PACKAGE_TESTS = IMPACTCHECK_PROGRAM=$(CURDIR)/target/release/impactcheck IMPACTCHECK_PYTHON=$(or $(IMPACTCHECK_PYTHON),$(CURDIR)/$(TOOL)) \
    $(WHEEL)/bin/python -m pytest -q -n auto --dist worksteal
SCRIPTS := fem_reference examples live python validation benches tests/freeze guide/check guide/generate
SCENES := $(basename $(notdir $(wildcard scenes/*.toml)))
# meshes of a solid at `fine` take an hour
PLATES := $(filter-out seal-seat-%,$(SCENES))
# struck off the centre, where model C needs a mesh and runs alone
ASIDE := scenes/validation/off-centre.toml
# dry impacts of elastic spheres that CalculiX solves too; its solutions come with the project
SECOND := $(PLATES) $(patsubst %,scenes/validation/%.toml,free-plate heavy-on-light polymer-plate supported-plate titanium-sapphire)

# the models for live pages
WASM   := target/wasm32-unknown-unknown/live/impactcheck_live.wasm

.PHONY: test passed setup lint lint-python live-page live-page-or-none rust docs wheel reference-tests package-tests live gate report solutions validation evidence

# packages are fetched while the compiler works; what fails within seconds comes first
test:
	@$(MAKE) --no-print-directory -j3 setup live-page-or-none lint lint-python docs
	@$(MAKE) --no-print-directory -j6 --output-sync=line reference-tests rust package-tests live gate
	@$(MAKE) --no-print-directory passed

# a program of its own: `setup` may have installed the browser
passed:
	@echo "all checks passed$(if $(UNCHECKED), but pages in a browser (as root: apt-get install chromium))$(if $(LEFT_OUT), but tests with CalculiX (as root: apt-get install calculix-ccx))"

setup:
	@.ci/setup

lint-python: setup
	$(VENV)/bin/ruff check $(SCRIPTS)
	$(VENV)/bin/ruff format --check $(SCRIPTS)
	guide/check
	$(TOOL) -m mypy

lint:
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings

# cargo sees that the file has changed, but not that it was made; the compressed one gets the other's time
live-page:
	@rustup target add wasm32-unknown-unknown
	@cargo build --profile live --package impactcheck-live --target wasm32-unknown-unknown
	@if [ ! -f $(WASM).gz ] || [ $(WASM) -nt $(WASM).gz ]; then \
	    gzip --best --no-name --keep --force $(WASM) && touch src/main.rs python/src/lib.rs; fi

live-page-or-none:
	@$(MAKE) --no-print-directory live-page || echo "the live page is not built and not tested: it needs rustup target add wasm32-unknown-unknown"

rust: lint
	@if cargo nextest --version >/dev/null 2>&1; then cargo nextest run --release --workspace --no-fail-fast $(if $(UNCHECKED),-E 'not test(/^$(UNCHECKED)/)'); \
	else cargo test --release --workspace $(if $(UNCHECKED),-- --skip $(UNCHECKED)); fi
	env -u MAKEFLAGS cargo test --release --workspace --doc

docs: lint
	RUSTDOCFLAGS="-D warnings" cargo doc --release --workspace --no-deps --quiet

# only the package's own crate is compiled for it, the rest serves tests and program too
wheel: setup
	rm -rf target/wheels
	$(VENV)/bin/maturin build --release --locked --quiet --interpreter $(PYTHON) --out target/wheels
	@$(WHEEL)/bin/python -c 'import xdist' 2>/dev/null || { $(PYTHON) -m venv $(WHEEL) && $(WHEEL)/bin/python -m pip install --quiet mypy numpy pytest pytest-xdist xarray; }
	$(WHEEL)/bin/python -m pip install --quiet --force-reinstall --no-deps target/wheels/*.whl

reference-tests: setup
	cargo build --release
	$(TOOL) -m pytest -q -n auto --dist worksteal -m 'not evidence$(LEFT_OUT)' fem_reference validation live

package-tests: setup wheel
	cargo build --release
	guide/generate target/release/impactcheck --check
	$(PACKAGE_TESTS) python
	$(WHEEL)/bin/python -m mypy.stubtest impactcheck._core

# a live finite-element run on coarse meshes, and the gate on what it gives; the scene is the one whose coarse mesh is
# good enough for the tolerances (10 mm spheres: the outer contact ends 0.6 us early on it)
live: setup wheel
	rm -rf $(OUT)/live
	$(RUN) doctor
	$(RUN) --store $(OUT)/live/store reference scaled-plate-r6.35 --resolution coarse
	$(RUN) --store $(OUT)/live/store gate scaled-plate-r6.35 --resolution coarse --out $(OUT)/live/report
	IMPACTCHECK_GUIDE=live cargo test --release --test command_line guide

# the gate on the stored references
gate:
	$(RUN) gate --out $(OUT)/gate --junit $(OUT)/gate/junit.xml
	$(PYTHON) examples/read_results.py $(OUT)/gate

report:
	$(RUN) compare

solutions: setup
	for scene in $(SCENES); do for resolution in coarse paper; do \
	    $(RUN) reference $$scene --resolution $$resolution --fresh || exit 1; done; done
	for scene in $(PLATES); do $(RUN) reference $$scene --resolution fine --fresh || exit 1; done
	$(RUN) reference scenes/validation/solid-plate-r10.toml --fresh
	# the stress pictures of the report: plates at the outer force's peak
	$(RUN) reference scaled-plate-r10 --stress-at 46.9e-6
	$(RUN) reference scaled-plate-r6.35 --stress-at 25.3e-6
	for seat in seal-seat-improved seal-seat-initial; do $(RUN) reference $$seat --stress-at 20e-6 || exit 1; done

validation: setup
	cargo build --release
	$(TOOL) validation/draw.py $(OUT)/validation/scenes
	IMPACTCHECK_PYTHON=$(PYTHON) $(TOOL) validation/solve.py $(OUT)/validation/scenes $(OUT)/validation/rows \
	    --known validation/base.jsonl $(if $(SHARD),--shard $(SHARD)) $(if $(LONGEST),--longest $(LONGEST))
	$(TOOL) validation/table.py $(OUT)/validation/rows validation/base.jsonl

evidence: setup wheel
	for scene in $(PLATES); do for resolution in coarse paper fine; do \
	    $(RUN) --store $(OUT)/evidence reference $$scene --resolution $$resolution || exit 1; done; done
	for scene in scenes/validation/*.toml; do \
	    $(RUN) --store $(OUT)/evidence reference $$scene --resolution paper || exit 1; done
	# the second program, and both beside each other
	for scene in $(SECOND); do $(RUN) --store $(OUT)/evidence reference $$scene --solver calculix --fresh || exit 1; done
	$(RUN) --store $(OUT)/evidence compare $(SECOND) --reference-check --out $(OUT)/second-program
	$(RUN) --store $(OUT)/evidence gate $(filter-out $(ASIDE),$(wildcard scenes/validation/*.toml)) --models B,C --out $(OUT)/evidence-report
	for model in B C; do $(RUN) --store $(OUT)/evidence gate $(ASIDE) --models $$model --out $(OUT)/evidence-aside-$$model || exit 1; done
	# what the map of validated scenes knows without these references
	$(RUN) --store $(OUT)/evidence coverage --record
	for study in prediction auto; do $(RUN) study $$study --out $(OUT)/studies || exit 1; done
	$(PYTHON) -m fem_reference bands --random 50 --out $(OUT)/bands
	$(PYTHON) -m fem_reference body-bands --random 8 --out $(OUT)/bands
	$(PYTHON) -m fem_reference yielding --out reports/yielding.md
	$(PYTHON) -m fem_reference rebound --out reports/rebound.md
	# a random tenth of the scenes that predictions rest on
	$(TOOL) validation/draw.py $(OUT)/validation/scenes
	IMPACTCHECK_PYTHON=$(PYTHON) $(TOOL) validation/check.py $(OUT)/validation/scenes validation/base.jsonl
	$(TOOL) -m pytest -q -n auto --dist worksteal -m evidence fem_reference live
	$(PACKAGE_TESTS) -m evidence python
	cargo nextest run --release --workspace --ignore-default-filter -E 'not default()'
	# flights of the sphere by another program
	$(TOOL) -m fem_reference flights --out fem_reference/solutions/flights.json
	for scene in $(PLATES); do $(PYTHON) -m fem_reference cost --out reports/reference-cost-$$scene.json \
	    --scene fem_reference/solutions/$$scene/paper/provenance.json || exit 1; done
	$(PYTHON) -m fem_reference speed --out reports/reference-speed.json \
	    --scene fem_reference/solutions/solid-plate-r10/paper/provenance.json
	IMPACTCHECK_GUIDE=slow cargo test --release --test command_line guide
	# a third kind of scene as an overlay
	tests/new-kind
	for study in table2 actuators rocker flight fluid damping shakedown test-bed insensitivity seal-seat seal-seat-direction seal-seat-cost; do $(RUN) study $$study --out $(OUT)/studies || exit 1; done
	for study in fig14 fig15 fig16 fig17 half-period; do $(RUN) study $$study --model C --out $(OUT)/studies || exit 1; done
	cargo build --release --manifest-path benches/diffsol/Cargo.toml
	$(RUN) bench --peer benches/diffsol/target/release/diffsol-peer --out $(OUT)/bench
	$(RUN) stress --cases 100000
	$(WHEEL)/bin/python -m pip install --quiet nbclient ipykernel
	cd examples && $(CURDIR)/$(WHEEL)/bin/python -c "import nbclient, nbformat; n = nbformat.read('impact.ipynb', 4); \
	    nbclient.NotebookClient(n, record_timing=False).execute(); nbformat.write(n, 'impact.ipynb')"
	$(PYTHON) benches/unneeded.py target/release/impactcheck $(addprefix --before ,$(BEFORE)) --out $(OUT)/unneeded
	python3 benches/kills.py target/release/impactcheck --out reports/kills.md
	$(TOOL) benches/records.py target/release/impactcheck --out reports/records.md
	fuzz/run.sh scene 1800
	fuzz/run.sh store 1800
	PROPTEST_CASES=200000 cargo test --release --test store random_input
	.ci/fenicsx-versions
