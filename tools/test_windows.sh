#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_windows.sh PYTHON OPENSUBDIV [--native | --blender VERSION]: compile for Windows with Zig, and test under Wine with
# a Windows Python: the self-test and the Python tests of the core; with --native, the core's own tests; with --blender,
# tests that need Blender on its official Windows module. Without Wine it prints the reason and skips. Needs the wheel of
# this source tree in build/wheel.
set -eu
python=$1
opensubdiv=$2
part=${3:-}
here=$(dirname "$0")
"$here/install_debian_packages.sh" "$here/debian_packages_windows.txt" ||
    { echo "windows: skipped, because Wine (package wine64) cannot be installed"; exit 0; }

if [ "$part" = --native ]; then
    "$here/portable_modules.sh" "$python" "$opensubdiv" windows-x64 stiv_tests
    tests=build/portable/windows-x64/cmake/native/tests
    "$here/wine.sh" "$tests/predicates/stiv_predicate_tests.exe"
    exec "$here/wine.sh" "$tests/stiv_tests.exe"
fi

windows=build/windows/3.11${4:+-blender-$4}
STIV_PYTHONS=3.11 "$here/portable_wheels.sh" "$python" "$opensubdiv" build/windows/wheels windows-x64
"$python" "$here/windows_python.py" 3.11 "$windows" -r "$here/requirements/foreign.txt" ${4:+bpy==$4}
"$python" "$here/windows_python.py" 3.11 "$windows" --no-deps build/windows/wheels/*.whl
[ -d build/windows/user ] || "$here/wine.sh" winecfg -v win10

run() { "$here/wine.sh" "$windows/python.exe" "$@"; }
run -m stiv.command_line self-test
if [ "$part" = --blender ]; then
    run -m pytest -q -p no:cacheprovider tests/addon/guard/test_undo_steps.py tests/blender/edit tests/addon/operators
else
    run -m pytest -q -p no:cacheprovider -m "not blender" $(cat "$here/core_tests.txt")
fi
