#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# extension.sh PYTHON OPENSUBDIV FOLDER PLATFORM...: build a zip of the extension for each of these platforms of
# tools/platforms.txt into FOLDER. Prints their names. Needs the wheel of this source tree in build/wheel.
set -eu
python=$1
opensubdiv=$2
folder=$3
shift 3
here=$(dirname "$0")
for platform; do
    wheels=build/portable/wheels/$platform
    "$here/portable_wheels.sh" "$python" "$opensubdiv" "$wheels" "$platform" >&2
    "$python" "$here/build_extension.py" "$folder" "$wheels"/*.whl
done
