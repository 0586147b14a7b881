#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# python_headers.sh VERSION SUITE DEST: unpack the headers of a version of Python, from a package of a Debian suite, into
# DEST/VERSION. Compiling a module for that version needs nothing else. Needs no privileges.
set -eu
[ $# -eq 3 ] || { echo "usage: python_headers.sh VERSION SUITE DEST" >&2; exit 2; }
version=$1
suite=$2
destination=$3
[ ! -f "$destination/$version/python$version/Python.h" ] || exit 0

. "$(dirname "$0")/private_apt.sh"
package=libpython$version-dev
echo "headers of Python $version: downloading Debian's $package ($suite)"
open_archive deb "$suite"
(cd "$work" && apt download "$package") || { cat "$work/log" >&2; fail "Debian $suite gave no $package"; }
dpkg -x "$work/$package"_*.deb "$work/unpacked"
[ -f "$work/unpacked/usr/include/python$version/Python.h" ] || fail "$package of Debian $suite holds no headers"
# Renamed when complete, so that an interrupted run leaves nothing that looks finished.
mkdir -p "$destination"
rm -rf "$destination/$version" "$destination/$version.partial"
cp -R "$work/unpacked/usr/include" "$destination/$version.partial"
# Debian's choice of a configuration knows its own processors only. All our systems are 64-bit, and differ in little else.
configuration=$(cd "$destination/$version.partial" && echo *-linux-gnu*/python"$version"/pyconfig.h)
cat >"$destination/$version.partial/python$version/pyconfig.h" <<END
#include <$configuration>
#ifdef __APPLE__
#undef HAVE_CRYPT_H
#endif
END
mv "$destination/$version.partial" "$destination/$version"
