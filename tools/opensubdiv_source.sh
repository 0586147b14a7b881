#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# opensubdiv_source.sh DEST: unpack the source of OpenSubdiv, from Debian's source package, into DEST. Needs no
# privileges: a separate list of sources and a separate folder leave the system's configuration unchanged.
set -eu
[ $# -eq 1 ] || { echo "usage: opensubdiv_source.sh DEST" >&2; exit 2; }
destination=$1
if [ -f "$destination/opensubdiv/far/stencilTable.h" ]; then
    echo "OpenSubdiv's source: there already, in $destination"
    exit 0
fi

. "$(dirname "$0")/private_apt.sh"
command -v apt-get >/dev/null || fail "apt-get is missing: unpack the source of OpenSubdiv 3.5 or later into $destination yourself"
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-sid}")
echo "OpenSubdiv's source: downloading Debian's source package ($suite)"
open_archive deb-src "$suite"
(cd "$work" && apt source --download-only opensubdiv) ||
    { cat "$work/log" >&2; fail "the source package could not be downloaded"; }

archive=$(find "$work" -maxdepth 1 -name 'opensubdiv_*.orig.tar.*' ! -name '*.asc' | head -n 1)
[ -n "$archive" ] || fail "the source package contains no original archive"
mkdir -p "$work/unpacked" "$destination"
(cd "$work/unpacked" && "${CMAKE:-cmake}" -E tar xf "$archive")  # tar needs xz, which a bare Debian does not have
unpacked=$(echo "$work"/unpacked/*)
[ -f "$unpacked/opensubdiv/far/stencilTable.h" ] || fail "$(basename "$archive") does not contain opensubdiv/far"
cp "$unpacked/LICENSE.txt" "$unpacked/NOTICE.txt" "$destination/"
# Renamed when complete, so that an interrupted run leaves nothing that looks finished.
rm -rf "$destination/opensubdiv.partial"
cp -R "$unpacked/opensubdiv" "$destination/opensubdiv.partial"
mv "$destination/opensubdiv.partial" "$destination/opensubdiv"
echo "OpenSubdiv's source: $(basename "$archive") unpacked into $destination"
