#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# source_archive.sh PYTHON FOLDER: write the source archive into FOLDER, from a copy of the files of the repository: in the
# real tree, the build backend may enter build/.
set -eu
python=$(realpath -s "$1")
mkdir -p "$2"
folder=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
git ls-files -z --cached --others --exclude-standard | tar --create --null --files-from - | tar --extract --directory "$work"
cd "$work"
"$python" -c 'import sys; from scikit_build_core.build import build_sdist; print(build_sdist(sys.argv[1]))' "$folder"
