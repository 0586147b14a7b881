#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# install_wheel.sh VENV: puts the wheel of build/wheel into the environment, in place of an older one.
set -eu
"$1/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --no-index --force-reinstall build/wheel/stiv-*.whl
