#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# opensubdiv_source.sh DEST: puts the source of OpenSubdiv, from Debian's source package, into DEST. Needs no privilege:
# a list of sources and a folder of package lists of its own leave the system's configuration alone.
set -eu
[ $# -eq 1 ] || { echo "usage: opensubdiv_source.sh DEST" >&2; exit 2; }
destination=$1
if [ -f "$destination/opensubdiv/far/stencilTable.h" ]; then
    echo "OpenSubdiv's source: there already, in $destination"
    exit 0
fi

fail() { echo "opensubdiv_source.sh: $1" >&2; exit 1; }
command -v apt-get >/dev/null || fail "apt-get is missing: unpack the source of OpenSubdiv 3.5 or later into $destination yourself"
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
[ -f "$keyring" ] || fail "$keyring is missing: install the package debian-archive-keyring"
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-sid}")

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"  # apt fetches as a user of its own where it can
mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
echo "deb-src [signed-by=$keyring] http://deb.debian.org/debian $suite main" >"$work/sources.list"

apt() {
    apt-get -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" \
        -o Acquire::Retries=5 -o Acquire::Languages=none "$@" >"$work/log" 2>&1
}
echo "OpenSubdiv's source: downloading Debian's source package ($suite)"
apt update || { cat "$work/log" >&2; fail "the list of Debian's source packages could not be read"; }
(cd "$work" && apt source --download-only opensubdiv) ||
    { cat "$work/log" >&2; fail "the source package could not be downloaded"; }

archive=$(find "$work" -maxdepth 1 -name 'opensubdiv_*.orig.tar.*' ! -name '*.asc' | head -n 1)
[ -n "$archive" ] || fail "the source package contains no original archive"
mkdir -p "$work/unpacked" "$destination"
tar -xf "$archive" -C "$work/unpacked" --strip-components=1
[ -f "$work/unpacked/opensubdiv/far/stencilTable.h" ] || fail "$(basename "$archive") does not contain opensubdiv/far"
cp "$work/unpacked/LICENSE.txt" "$work/unpacked/NOTICE.txt" "$destination/"
# Renamed when complete: a run that was interrupted leaves nothing that looks finished.
rm -rf "$destination/opensubdiv.partial"
cp -R "$work/unpacked/opensubdiv" "$destination/opensubdiv.partial"
mv "$destination/opensubdiv.partial" "$destination/opensubdiv"
echo "OpenSubdiv's source: $(basename "$archive") unpacked into $destination"
