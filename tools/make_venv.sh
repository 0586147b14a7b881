#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# make_venv.sh PYTHON FOLDER PIP_ARGUMENT...: create a virtual environment with these packages; tolerates slow networks.
set -eu
python=$1
folder=$2
shift 2
[ -x "$folder/bin/python" ] || "$python" -m venv "$folder"
echo "$folder: pip install $*"
exec "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --retries 10 --timeout 180 "$@"
