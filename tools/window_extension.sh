#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# window_extension.sh PYTHON SUITE FOLDER: build the extension's zip into FOLDER for the Python of a Debian SUITE that is
# not older than this system. Prints its name. Uses the wheel of this source tree if it is for that Python; otherwise
# compiles the bindings again, with the core in build/native.
set -eu
python=$1
suite=$2
folder=$3
here=$(dirname "$0")
version=$(while read -r each of; do [ "$of" != "$suite" ] || echo "$each"; done <"$here/extension_pythons.txt")
[ -n "$version" ] || { echo "window_extension.sh: no Debian $suite in tools/extension_pythons.txt" >&2; exit 2; }
tag=cp$(echo "$version" | tr -d .)

case "$(echo build/wheel/*.whl)" in
*-"$tag"-*) wheels=$(echo build/wheel/*.whl) ;;
*)
    headers=$folder/headers
    "$here/python_headers.sh" "$version" "$suite" "$headers" >&2
    mkdir -p "$folder"
    echo "$folder: compiling the module for Python $version" >&2
    { cmake -S . -B build/native "-DSTIV_PYTHON_HEADERS=$version=$PWD/$headers/$version" &&
        cmake --build build/native --target stiv_portable_modules; } >"$folder/build.log" 2>&1 ||
        { cat "$folder/build.log" >&2; exit 1; }
    "$python" "$here/portable_wheels.py" build/wheel/*.whl "$folder/wheels" linux_x86_64 \
        "build/native/native/bindings/_native.cpython-${tag#cp}-x86_64-linux-gnu.so"
    wheels=$(echo "$folder"/wheels/*.whl)
    ;;
esac
"$python" "$here/build_extension.py" "$folder" "$wheels"
