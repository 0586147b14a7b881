#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# build_wheel.sh PYTHON OPENSUBDIV: build the wheel of this source tree into build/wheel, compiled in build/native. That
# folder remains, so that the next wheel compiles only changed files; the native tests are built in it too.
set -eu
python=$1
opensubdiv=$(realpath "$2")
echo "build/wheel: compiling the core and the Python module (minutes, the first time)"
rm -f build/wheel/*.whl
"$python" -m pip wheel . --no-deps --no-build-isolation --disable-pip-version-check --quiet --wheel-dir build/wheel \
    --config-settings build-dir=build/native \
    --config-settings cmake.define.STIV_BUILD_TESTS=ON \
    --config-settings "cmake.define.STIV_OPENSUBDIV_SOURCE=$opensubdiv"
