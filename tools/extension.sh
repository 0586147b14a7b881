#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# extension.sh PYTHON OPENSUBDIV FOLDER [VERSION...]: build the extension's zip into FOLDER, with wheels for these
# versions of Python, or for all supported ones. Prints its name. Needs the wheel of this source tree in build/wheel.
set -eu
python=$1
opensubdiv=$2
folder=$3
shift 3
here=$(dirname "$0")
"$here/portable_modules.sh" "$python" "$opensubdiv" "$@" >&2
"$python" "$here/portable_wheels.py" build/wheel/*.whl build/portable/wheels manylinux_2_17_x86_64 \
    build/portable/cmake/native/bindings/_native.*.so
"$python" "$here/build_extension.py" "$folder" build/portable/wheels/*.whl
