#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# arm64_python.sh PYTHON DEST [PIP_ARGUMENT...]: unpack Debian 12's arm64 Python 3.11 into DEST, with packages of PyPI that
# PYTHON's pip installs for it. It runs with `qemu-aarch64 -L DEST DEST/usr/bin/python3.11`. Needs no privileges.
set -eu
[ $# -ge 2 ] || { echo "usage: arm64_python.sh PYTHON DEST [PIP_ARGUMENT...]" >&2; exit 2; }
python=$1
destination=$2
shift 2
if [ ! -x "$destination/usr/bin/python3.11" ]; then
    . "$(dirname "$0")/private_apt.sh"
    echo "$destination: downloading Debian's arm64 Python"
    apt_options="-o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State::status=/dev/null"
    open_archive deb bookworm
    (cd "$work" && apt download python3.11-minimal libpython3.11-minimal libpython3.11-stdlib libc6 libgcc-s1 libstdc++6 \
        zlib1g libexpat1 libffi8 libssl3 libbz2-1.0 liblzma5 libsqlite3-0 libuuid1 libcrypt1 libdb5.3) ||
        { cat "$work/log" >&2; fail "Debian's arm64 Python could not be downloaded"; }
    rm -rf "$destination" "$destination.partial"
    mkdir -p "$destination.partial"
    for package in "$work"/*.deb; do dpkg -x "$package" "$destination.partial"; done
    mv "$destination.partial" "$destination"
fi
[ $# -eq 0 ] || "$python" -m pip install --quiet --disable-pip-version-check --target "$destination/packages" --upgrade \
    --platform manylinux2014_aarch64 --python-version 3.11 --implementation cp --only-binary=:all: "$@"
