#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# portable_wheels.sh PYTHON OPENSUBDIV FOLDER PLATFORM: build the wheels of a platform of tools/platforms.txt, for
# all its versions of Python, into FOLDER. Needs the wheel of this source tree in build/wheel.
set -eu
here=$(dirname "$0")
tag=$(sed -n "s/^$4  *//p" "$here/platforms.txt" | awk '{ print $5 }')
"$here/portable_modules.sh" "$1" "$2" "$4"
"$1" "$here/portable_wheels.py" build/wheel/*.whl "$3" "$tag" "build/portable/$4/cmake/native/bindings/_native."*
