# SPDX-License-Identifier: GPL-3.0-or-later
# Each target does its own set-up. A finished step leaves a file under build/, so that it does not run twice.

PYTHON := $(shell tools/choose_python.sh)
BLENDERS := $(shell $(PYTHON) tools/blender_versions.py)
DEMO_BLENDER := $(shell $(PYTHON) tools/blender_versions.py --demo)

NATIVE_SOURCES := CMakeLists.txt CMakePresets.json $(shell find cmake native -type f)
PYTHON_SOURCES := pyproject.toml README.md $(shell find python addon licenses blend_fixtures -type f -not -path '*/__pycache__/*')
OPENSUBDIV := build/opensubdiv
WHEEL := build/wheel/ready
EXTENSION := build/extension
ZIP_VENV := build/venv-blender-$(firstword $(BLENDERS))
EXTENSION_TOOLS := tools/build_extension.py tools/build_guide.py addon/blender_manifest.toml \
	$(wildcard docs/user_guide.md docs/images/* docs/films/* blend_fixtures/examples/*)
PLATFORMS := $(shell sed -n 's/^\([a-z][^ ]*\).*/\1/p' tools/platforms.txt)
HERE := linux_x64
WINDOWS_BLENDERS := 4.5.15 5.2.3
FUZZ_SECONDS := 30
WINDOW_RELEASE := trixie
WINDOW_SEQUENCES := 200
BENCHMARKS := $(patsubst benchmarks/%.py,%,$(wildcard benchmarks/*.py)) \
	$(patsubst benchmarks/%/__main__.py,%,$(wildcard benchmarks/*/__main__.py))
BLENDER_VENVS := $(BLENDERS:%=build/venv-blender-%/ready)
BLENDER_MODULES := $(BLENDERS:%=build/venv-blender-%/downloaded)

ifneq ($(shell command -v ccache),)
export CMAKE_CXX_COMPILER_LAUNCHER := ccache
export CCACHE_SLOPPINESS := pch_defines,time_macros
endif

.PHONY: release docs test-docs test-long test-arm64 test-arm64-native test-arm64-python peers fuzz coverage help demo test wheels test-windows test-windows-native test-windows-blender test-native test-sanitizers test-threads test-python test-blender test-window lint extension bench format clean
.SILENT:
# Several steps write to build/venv. `make test` downloads Blender's modules, which no other step writes to, beside the
# compiler.
ifndef DOWNLOAD_BESIDE
.NOTPARALLEL:
endif

help: ## List the targets
	sed -n 's/^\([a-z-]*\):.*## /\1\t/p' Makefile | expand -t 18

demo: build/venv-blender ## Lower a plant into a vase in Blender, write build/demo/ and check the result
	build/venv-blender/bin/python -m stiv.command_line demo --output build/demo

test: ## Run every test on every Blender module
	$(MAKE) --no-print-directory --jobs=2 DOWNLOAD_BESIDE=1 build/stiv_tests $(BLENDER_MODULES) build/stiv_sanitized_tests build/stiv_thread_tests
	$(MAKE) --no-print-directory build/venv/stiv build/venv/lint $(BLENDER_VENVS)
	build/venv/bin/python tools/run_tests.py native sanitizers window blender python lint threads windows

test-native: build/stiv_tests ## Run the core's own tests
	build/venv/bin/python tools/run_tests.py native

test-sanitizers: build/stiv_sanitized_tests ## Run the core's own tests under address and undefined-behaviour sanitizers
	build/venv/bin/python tools/run_tests.py sanitizers

test-threads: build/stiv_thread_tests ## Run the tests of multithreaded code under the thread sanitizer
	build/venv/bin/python tools/run_tests.py threads

test-python: build/venv/stiv build/venv/lint ## Run the Python tests that need no Blender
	build/venv/bin/python tools/run_tests.py python

test-blender: $(BLENDER_VENVS) build/venv/stiv ## Run the tests that need Blender on every Blender module
	build/venv/bin/python tools/run_tests.py blender

test-window: $(WHEEL) ## Drive the installed zip in a real window (needs root and debootstrap); WINDOW_RELEASE=sid: in Blender 5.2
	build/venv/bin/python tests/window/run.py --release $(WINDOW_RELEASE) --sequences $(WINDOW_SEQUENCES)

lint: build/venv/lint $(WHEEL) ## Check format, style, types, spelling, and the wording of documents and code
	build/venv/bin/python tools/run_tests.py lint

extension: build/venv/stiv $(OPENSUBDIV) build/venv/portable $(BLENDER_VENVS) ## Build dist/stiv-<version>-<platform>.zip for all PLATFORMS (an hour, the first time), validate and test them; BLENDER=blender: install it there
	tools/install_debian_packages.sh tools/debian_packages_extension.txt
	tools/extension.sh build/venv/bin/python $(OPENSUBDIV) dist $(PLATFORMS) >build/extension-all
	build/venv/bin/python tools/validate_extension.py build/validators $$(cat build/extension-all)
	set -e; for zip in $$(grep $(HERE) build/extension-all); do $(ZIP_VENV)/bin/python tools/install_extension.py "$$zip"; done
	build/venv/bin/python -m pytest -q -p no:cacheprovider tests/packaging/test_extension_wheels.py
	cat build/extension-all
ifdef BLENDER
	build/venv/bin/python tools/install_extension.py "$$(grep $(HERE) build/extension-all)" --blender "$(BLENDER)"
endif

release: extension ## Build a release in dist/release: zips for the extension platform, wheels and sources for PyPI, notes, hashes
	rm -f dist/*.tar.gz
	tools/source_archive.sh build/venv/bin/python dist
	build/venv/bin/python tools/release.py dist dist/release

wheels: build/venv/stiv $(OPENSUBDIV) build/venv/portable ## Build the wheels of all PLATFORMS into dist: those in the zips
	set -e; for platform in $(PLATFORMS); do tools/portable_wheels.sh build/venv/bin/python $(OPENSUBDIV) dist $$platform; done

bench: build/venv/bench ## Run every benchmark with its default settings, and the compared libraries from PyPI
	set -e; for name in $(BENCHMARKS); do echo "== $$name"; build/venv/bin/python -m benchmarks.$$name; done

peers: build/venv/bench build/cgal ## Install the libraries that benchmarks compare with: ipctk and libigl from PyPI, CGAL from Debian

fuzz: $(OPENSUBDIV) build/venv/stiv ## Fuzz pair tests, detection, the static test, edits and file readers: make fuzz FUZZ_SECONDS=600 (each; default 30)
	tools/install_debian_packages.sh tools/debian_packages_fuzz.txt
	cmake --preset fuzz -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build --preset fuzz
	tools/fuzz.sh build/fuzz $(FUZZ_SECONDS)
	build/venv/bin/python -W ignore tests/long/file_fuzzing.py --seconds $(FUZZ_SECONDS) --findings build/fuzz

test-arm64: test-arm64-native test-arm64-python ## Run the core's own tests and the Python tests for arm64 in an emulator

test-arm64-native: $(OPENSUBDIV) ## Compile the core's own tests for arm64 with Debian's compiler, and run them in an emulator
	tools/install_debian_packages.sh tools/debian_packages_arm64.txt
	cmake --preset arm64 -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build --preset arm64 --target stiv_tests
	ctest --preset arm64 --output-on-failure --parallel 2

test-arm64-python: $(WHEEL) build/venv/portable ## Run the self-test and the Python tests of the core in an emulator, with the wheel of the zip for arm64
	tools/install_debian_packages.sh tools/debian_packages_arm64.txt
	tools/arm64_python.sh build/venv/bin/python build/arm64-python -r tools/requirements/arm64.txt
	STIV_PYTHONS=3.11 tools/portable_wheels.sh build/venv/bin/python $(OPENSUBDIV) build/arm64-python/wheel linux-arm64
	tools/test_arm64.sh build/venv/bin/python build/arm64-python

test-windows: $(WHEEL) build/venv/portable ## Compile for Windows, and run the self-test and the Python tests of the core under Wine
	tools/test_windows.sh build/venv/bin/python $(OPENSUBDIV)

test-windows-native: build/venv/portable $(OPENSUBDIV) ## Run the core's own tests under Wine (half an hour to compile)
	tools/test_windows.sh build/venv/bin/python $(OPENSUBDIV) --native

test-windows-blender: $(WHEEL) build/venv/portable ## Install the zip into Blender's official Windows modules under Wine, and run tests there
	tools/test_windows.sh build/venv/bin/python $(OPENSUBDIV) --blender $(WINDOWS_BLENDERS)

coverage: build/debian $(OPENSUBDIV) ## Run the core's own tests for line coverage; detection, acceptance and penetration need 95 %
	tools/install_debian_packages.sh tools/debian_packages_coverage.txt
	cmake --preset coverage -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build --preset coverage --target stiv_tests
	find build/coverage -name '*.gcda' -delete
	build/coverage/native/tests/stiv_tests
	$(PYTHON) tools/coverage.py build/coverage --at-least 95 detection acceptance penetration

format: build/venv/lint ## Format C++ and Python in place
	tools/lint.sh --fix

test-long: build/venv/stiv build/venv-blender build/stiv_thread_tests ## Run the long tests: everything under the thread sanitizer, tests of the core instrumented too, killed batches, random edits with all paths, cancelled edits, stacks of modifiers, random events and snaps in a window, soak, memory, pip install from source
	cmake --build --preset tsan --target stiv_tests
	ctest --preset tsan --output-on-failure
	cmake --preset asan -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build --preset asan --target stiv_tests
	ctest --preset asan --output-on-failure
	build/venv/bin/python tests/long/batch_kills.py --scenes 200 --kills 50
	build/venv/bin/python tests/long/random_sessions.py --steps 20000
	build/venv/bin/python tests/long/cancelling.py --times 200
	build/venv-blender/bin/python tests/long/cancelling_in_blender.py --times 200
	build/venv-blender/bin/python tests/long/random_poses.py --poses 500
	build/venv-blender/bin/python tests/long/stack_trials.py
	build/venv/bin/python tests/window/run.py --sequences 500 --limit 7200 random_sequences
	STIV_WINDOW_SNAPS=50 build/venv/bin/python tests/window/run.py snaps_as_blender
	build/venv/bin/python tests/long/soak.py --drags 10000 --seeds 1 2 3
	build/venv-blender/bin/python tests/long/soak_in_blender.py --drags 10000
	build/venv/bin/python tests/long/cluster_throughput.py
	build/venv/bin/python tests/long/source_archive.py
	STIV_LONG=1 build/venv/bin/python -m pytest -q tests/faults/test_memory.py tests/editing/test_random_deformations.py
	STIV_LONG=1 build/venv-blender/bin/python -m pytest -q tests/fixtures/test_random_edits.py tests/fixtures/test_figures.py

docs: build/venv-docs/ready ## Build the documentation site with the references of Python and C++: build/site/index.html
	tools/install_debian_packages.sh tools/debian_packages_docs.txt
	mkdir -p build/docs
	doxygen docs/Doxyfile
	rm -rf build/site-source
	$(PYTHON) tools/site_pages.py build/site-source build/docs/html
	NO_MKDOCS_2_WARNING=1 build/venv-docs/bin/python -m mkdocs build --quiet --strict -f docs/site/mkdocs.yml
	echo build/site/index.html

test-docs: docs build/venv/lint ## Build the documentation site, and check its links, formulas, reference and search
	tools/install_debian_packages.sh tools/debian_packages_browser.txt
	STIV_SITE=build/site build/venv/bin/python -m pytest -q -p no:cacheprovider tests/packaging/test_site.py

clean: ## Remove everything that was built or downloaded
	rm -rf build dist

# Set-up, one rule per step.

build/debian: tools/debian_packages.txt tools/install_debian_packages.sh
	tools/install_debian_packages.sh tools/debian_packages.txt
	mkdir -p $(@D) && touch $@

build/venv/ready: tools/requirements/build.txt tools/requirements/test.txt | build/debian
	tools/make_venv.sh $(PYTHON) build/venv -r tools/requirements/build.txt -r tools/requirements/test.txt
	touch $@

build/venv/lint: tools/requirements/lint.txt build/venv/ready
	tools/make_venv.sh $(PYTHON) build/venv -r tools/requirements/lint.txt
	touch $@

build/venv-docs/ready: tools/requirements/docs.txt | build/debian
	tools/make_venv.sh $(PYTHON) build/venv-docs -r tools/requirements/docs.txt
	touch $@

build/venv/bench: tools/requirements/bench.txt build/venv/stiv
	tools/make_venv.sh $(PYTHON) build/venv -r tools/requirements/bench.txt
	touch $@

build/cgal: tools/debian_packages_peers.txt benchmarks/intersections/cgal_self_intersections.cpp $(OPENSUBDIV)
	tools/install_debian_packages.sh tools/debian_packages_peers.txt
	cmake -S . -B build/bench -G Ninja -DSTIV_BUILD_BENCHMARKS=ON -DSTIV_BUILD_TESTS=OFF -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build build/bench --target cgal_self_intersections
	touch $@

$(OPENSUBDIV): tools/opensubdiv_source.sh | build/debian
	tools/opensubdiv_source.sh $@
	touch $@

$(WHEEL): $(NATIVE_SOURCES) $(PYTHON_SOURCES) build/venv/ready $(OPENSUBDIV)
	tools/build_wheel.sh build/venv/bin/python $(OPENSUBDIV)
	touch $@

build/venv/portable: tools/requirements/portable.txt build/venv/ready
	tools/make_venv.sh $(PYTHON) build/venv -r tools/requirements/portable.txt
	touch $@

# Uses the wheel of the tests, for this Python only; `make extension` compiles for all versions, and for old systems.
$(EXTENSION): $(WHEEL) $(EXTENSION_TOOLS)
	build/venv/bin/python tools/build_extension.py build/extension-here build/wheel/*.whl >$@.new
	mv $@.new $@

build/venv/stiv: $(WHEEL)
	tools/install_wheel.sh build/venv
	touch $@

build/stiv_tests: $(WHEEL)
	cmake --build build/native --target stiv_tests
	touch $@

build/stiv_sanitized_tests: build/stiv_tests
	cmake --build build/native --target stiv_sanitized_tests
	touch $@

build/stiv_thread_tests: $(NATIVE_SOURCES) $(OPENSUBDIV)
	cmake --preset tsan -DSTIV_OPENSUBDIV_SOURCE=$(abspath $(OPENSUBDIV))
	cmake --build --preset tsan --target stiv_thread_tests
	touch $@

.PRECIOUS: build/venv-blender-%/downloaded
build/venv-blender-%/downloaded: tools/requirements/test.txt | build/debian
	tools/make_venv.sh $(PYTHON) $(@D) bpy==$* -r tools/requirements/test.txt
	touch $@

# Each finds the package like a user's Blender: in the files that Blender unpacked from the zip.
build/venv-blender-%/ready: build/venv-blender-%/downloaded $(EXTENSION) tools/install_extension.py
	$(@D)/bin/python tools/install_extension.py "$$(cat $(EXTENSION))"
	touch $@

build/venv-blender: build/venv-blender-$(DEMO_BLENDER)/ready
	ln -sfn venv-blender-$(DEMO_BLENDER) $@
