#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# test_arm64.sh FOLDER MODULE: run the self-test and the fast Python tests of the core with this native module, in an
# emulator, with the arm64 Python in FOLDER.
set -eu
folder=$1
module=$2
here=$(dirname "$0")
rm -rf "$folder/stiv"
mkdir -p "$folder/stiv"
cp -R python/stiv "$folder/stiv/"
cp "$module" "$folder/stiv/stiv/"
run() {
    PYTHONPATH="$PWD/$folder/stiv:$PWD/$folder/packages" PYTHONDONTWRITEBYTECODE=1 \
        qemu-aarch64 -L "$folder" "$folder/usr/bin/python3.11" "$@"
}
run -m stiv.command_line self-test
run -m pytest -q -p no:cacheprovider -m "not blender" $(cat "$here/core_tests.txt")
