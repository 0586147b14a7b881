#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# install_wheel.sh VENV: install the wheel of build/wheel into the environment, replacing an older one.
set -eu
"$1/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --no-index --force-reinstall build/wheel/stiv-*.whl
