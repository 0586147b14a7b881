#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# install_debian_packages.sh LIST: install the missing packages of the list, as root or through sudo.
set -eu
missing=""
for package in $(sed 's/#.*//' "$1"); do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
if [ -z "$missing" ]; then
    echo "Debian packages: all there"
    exit 0
fi

echo "Debian packages to install:$missing"
sudo=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "Run as root, or install sudo, or: apt-get install$missing" >&2; exit 1; }
    sudo=sudo
fi
apt() { $sudo env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=5 -o DPkg::Lock::Timeout=300 "$@"; }
log=$(mktemp)
apt update >"$log" 2>&1 || echo "apt-get update had errors; continuing with the existing lists"
if apt install -y --no-install-recommends $missing >>"$log" 2>&1; then
    rm "$log"
else
    tail -n 30 "$log" >&2
    echo "Installing Debian packages failed; the full log is $log" >&2
    exit 1
fi
