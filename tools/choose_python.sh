#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Print the interpreter to build for: the first of $STIV_PYTHON, python3 and Debian's own python3 for which PyPI has a
# Blender module (tools/blender_versions.toml). Falls back to python3; the next step then explains the error.
here=$(dirname "$0")
for candidate in ${STIV_PYTHON:-} python3 /usr/bin/python3; do
    if "$candidate" "$here/blender_versions.py" >/dev/null 2>&1; then
        exec "$candidate" -c 'import sys; print(sys.executable)'
    fi
done
echo python3
