# Everyday commands. Each works on a fresh Debian machine that has the Rust toolchain and a C compiler.
CARGO ?= cargo
OUT := out
# Random tests draw from this seed, so that a run can be repeated; try others: make test SEED=2
SEED ?= 1
# What `make run` records.
SIGNALS := path.speed,S.rpm,X.actual,X.lag,Z.actual,Z.lag,M2045,M2482,M2046,M2483

.PHONY: run test check deps bench doc pictures conformance decisions faults torture trails tools browser terminal axe pylsv2 clean

# Built for the first look: without the screens in the terminal, and with the profile for it.
BAHN := $(CARGO) run --quiet --profile quick -p bahn --no-default-features --

# The main job: a program without a machine, then the programs of a machine on it, in closed loop with its
# PLC; reports on the screen, pictures beside them.
run:
	@mkdir -p $(OUT)
	$(BAHN) test examples/housing.H \
		--view 3d --image $(OUT)/housing.png --path $(OUT)/housing.svg --mesh $(OUT)/housing.stl
	@for program in BRACKET INDEX SADDLE; do \
		echo; \
		image=; \
		if grep -q "BLK FORM" machines/mill/programs/$$program.H; then image="--image $(OUT)/$$program.png"; fi; \
		$(BAHN) run $$program.H --machine machines/mill --fresh \
			$$image --record $(OUT)/$$program.csv --signals $(SIGNALS) || exit 1; \
		echo; \
		$(BAHN) scope $(OUT)/$$program.csv -o $(OUT)/$$program-scope.png \
			--title "$$program.H on machines/mill" || exit 1; \
	done
	@echo
	@echo "Pictures: $(OUT)/*.png   tool path: $(OUT)/housing.svg   part: $(OUT)/housing.stl   recordings: $(OUT)/*.csv"

# Everything that must hold: format, lints, documentation, tests. Of the fuzz targets nothing is linked here: they
# compile without libFuzzer.
test: deps
	$(CARGO) fmt --all --check
	$(CARGO) metadata --manifest-path fuzz/Cargo.toml --locked --format-version 1 >/dev/null
	$(CARGO) clippy --workspace --all-targets --locked -- -D warnings
	$(CARGO) clippy -p bahn --no-default-features --locked -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --workspace --no-deps --locked --quiet
	PROPTEST_RNG_SEED=$(SEED) $(CARGO) test --workspace --locked --quiet
	CUSTOM_LIBFUZZER_PATH=none/libnone.a CARGO_TARGET_DIR=$${CARGO_TARGET_DIR:-$(CURDIR)/target} \
		$(CARGO) check --manifest-path fuzz/Cargo.toml --locked --quiet
	$(CARGO) package --workspace --locked --no-verify --allow-dirty --quiet
	@mkdir -p $(OUT)
	BAHN_TRAIL=$(CURDIR)/$(OUT)/debug.trail $(CARGO) test -p bahn-tnc --locked --quiet --test reproducible twice
	BAHN_TRAIL=$(CURDIR)/$(OUT)/release.trail $(CARGO) test -p bahn-tnc --locked --quiet --release --test reproducible twice
	cmp $(OUT)/debug.trail $(OUT)/release.trail

# What a change is looked at with before everything is tried: format, lints, the order of the house, the tests of the
# rooms with files that are not committed yet.
check: tools
	$(CARGO) fmt --all --check
	$(CARGO) clippy --workspace --all-targets --locked -- -D warnings
	$(CARGO) test -p bahn-house --locked --quiet
	@for room in $$(git status --porcelain -- crates | cut -c4- | cut -d/ -f3 | sort -u | grep -v '^bahn$$'); do \
		$(CARGO) test -p bahn-$$room --locked --quiet || exit 1; \
	done

# What the tests need and a fresh machine lacks. Nothing is done where it is there.
deps: tools browser terminal axe pylsv2

bench:
	$(CARGO) bench --workspace --locked

doc:
	$(CARGO) doc --workspace --no-deps --open

# The pictures of README and examples/README.md, made anew.
pictures:
	$(CARGO) build --quiet --release -p bahn
	./examples/pictures.sh

# What every shipped program and 400 random runs do, as one number each, to compare two versions.
trails:
	@mkdir -p $(OUT)
	BAHN_TRAILS=$(CURDIR)/$(OUT)/trails.txt $(CARGO) test -p bahn --locked --quiet --release --test trails the_trails -- --ignored

# docs/conformance.md, made anew from the registry.
conformance:
	BAHN_WRITE_DOCS=1 $(CARGO) test -p bahn --locked --quiet --test conformance the_document

# docs/decisions.md, made anew from the decisions beside the code.
decisions:
	BAHN_WRITE_DOCS=1 $(CARGO) test -p bahn-house --locked --quiet --test decisions the_document

# docs/faults.md, made anew from the table of faults.
faults:
	BAHN_WRITE_DOCS=1 $(CARGO) test -p bahn --locked --quiet --test torture the_document

# A long fault campaign over the shipped machines: make torture SEEDS=0..100000
SEEDS ?= 0..20000
torture:
	$(CARGO) run --quiet --release -p bahn -- torture --seeds $(SEEDS)

# Parts of the toolchain that a minimal installation lacks.
tools:
	@$(CARGO) fmt --version >/dev/null 2>&1 || rustup component add rustfmt
	@$(CARGO) clippy --version >/dev/null 2>&1 || rustup component add clippy

# The browser that the tests of pages start. Where it cannot be installed they say that they are skipped, under
# continuous integration they fail.
browser:
	@for name in "$${BAHN_CHROMIUM:-chromium}" chromium-browser google-chrome google-chrome-stable; do \
		command -v "$$name" >/dev/null 2>&1 && exit 0; \
	done; \
	as_root=; [ "$$(id -u)" = 0 ] || as_root="sudo -n"; \
	echo "installing Chromium for the tests of pages"; \
	{ $$as_root apt-get update -q && \
		DEBIAN_FRONTEND=noninteractive $$as_root apt-get install -q -y --no-install-recommends chromium; } \
		>/dev/null 2>&1 || echo "Chromium cannot be installed: the tests of pages are skipped"

# The terminal without a window in which the panel is tested; the same of it.
terminal:
	@command -v tmux >/dev/null 2>&1 && exit 0; \
	as_root=; [ "$$(id -u)" = 0 ] || as_root="sudo -n"; \
	echo "installing tmux for the tests of the panel in the terminal"; \
	{ $$as_root apt-get update -q && \
		DEBIAN_FRONTEND=noninteractive $$as_root apt-get install -q -y --no-install-recommends tmux; } \
		>/dev/null 2>&1 || echo "tmux cannot be installed: the tests of the panel in the terminal are skipped"

# The rules by which the tests look whether the pages can be used by everybody: one file, known by its sum.
AXE := axe-core-4.14.1
AXE_SUM := 29348999450cdf2849a8e70b7912fc2da85a849da39c0d0d5394f51d4a9ed95c
axe:
	@mkdir -p $(OUT)
	@echo "$(AXE_SUM)  $(OUT)/axe.min.js" | sha256sum --check --status 2>/dev/null && exit 0; \
	as_root=; [ "$$(id -u)" = 0 ] || as_root="sudo -n"; \
	command -v npm >/dev/null 2>&1 || { echo "installing npm, which fetches axe-core"; \
		$$as_root apt-get update -q && \
		DEBIAN_FRONTEND=noninteractive $$as_root apt-get install -q -y --no-install-recommends npm; } >/dev/null 2>&1; \
	{ cd $(OUT) && npm pack --silent $(subst core-,core@,$(AXE)) && \
		tar xzf $(AXE).tgz --strip-components=1 package/axe.min.js && rm $(AXE).tgz && \
		echo "$(AXE_SUM)  axe.min.js" | sha256sum --check --status; } >/dev/null 2>&1 || \
		{ rm -f $(OUT)/axe.min.js; echo "axe-core cannot be fetched: its rules are skipped"; }

# A client of LSV/2 that shops use, in a virtual environment of its own; the tests of the port use it as a host does.
PYLSV2 := pyLSV2==1.8.0
pylsv2:
	@mkdir -p $(OUT)
	@$(OUT)/pylsv2/bin/python -c "import pyLSV2" 2>/dev/null && exit 0; \
	as_root=; [ "$$(id -u)" = 0 ] || as_root="sudo -n"; \
	python3 -c "import ensurepip, venv" 2>/dev/null || { echo "installing Python for the tests of LSV/2"; \
		$$as_root apt-get update -q && \
		DEBIAN_FRONTEND=noninteractive $$as_root apt-get install -q -y --no-install-recommends python3-venv; } >/dev/null 2>&1; \
	{ python3 -m venv $(OUT)/pylsv2 && $(OUT)/pylsv2/bin/pip install -q $(PYLSV2); } >/dev/null 2>&1 || \
		{ rm -rf $(OUT)/pylsv2; echo "pyLSV2 cannot be fetched: what it does is skipped"; }

clean:
	$(CARGO) clean
	rm -rf $(OUT)
