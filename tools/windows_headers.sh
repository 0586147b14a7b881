#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# windows_headers.sh VERSION SUITE DEST ZIG: into DEST/VERSION, the headers of a version of Python for Windows and the
# import library of its DLL. Both come from a Debian suite: the headers from the source package, and the names in the
# library from those that Debian's own library exports. Needs no privileges.
set -eu
[ $# -eq 4 ] || { echo "usage: windows_headers.sh VERSION SUITE DEST ZIG" >&2; exit 2; }
version=$1
suite=$2
destination=$3
zig=$4
short=$(echo "$version" | tr -d .)
[ ! -f "$destination/$version/libpython$short.a" ] || exit 0

. "$(dirname "$0")/private_apt.sh"
echo "headers of Python $version for Windows: downloading Debian's python$version ($suite)"
open_archive deb-src "$suite"
(cd "$work" && apt source --download-only "python$version") ||
    { cat "$work/log" >&2; fail "Debian $suite gave no source of Python $version"; }
open_archive deb "$suite"
(cd "$work" && apt download "libpython$version") ||
    { cat "$work/log" >&2; fail "Debian $suite gave no libpython$version"; }

partial=$destination/$version.partial
rm -rf "$partial" "$destination/$version"
mkdir -p "$partial" "$work/source"
archive=$(find "$work" -maxdepth 1 -name "python${version}_*.orig.tar.*" ! -name '*.asc' | head -n 1)
[ -n "$archive" ] || fail "the source package of Python $version contains no original archive"
tar -xf "$archive" -C "$work/source" --strip-components=1
cp -R "$work/source/Include" "$partial/python$version"
for name in pyconfig.h pyconfig.h.in; do  # a template from 3.13 on, which fits as it is
    [ ! -f "$work/source/PC/$name" ] || cp "$work/source/PC/$name" "$partial/python$version/pyconfig.h"
done

dpkg -x "$work/libpython$version"_*.deb "$work/library"
{
    echo "LIBRARY python$short.dll"
    echo EXPORTS
    nm -D --defined-only "$work/library"/usr/lib/*/libpython"$version".so.1.0 |
        awk '$3 ~ /^_?Py/ { print "  " $3 ($2 ~ /[BDRV]/ ? " DATA" : "") }' | sort -u
} >"$partial/python$short.def"
"$zig" dlltool -m i386:x86-64 -d "$partial/python$short.def" -l "$partial/libpython$short.a"
mv "$partial" "$destination/$version"
