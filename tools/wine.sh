#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# wine.sh PROGRAM ARGUMENT...: run a Windows program under Wine, with a user's folder of its own below build/windows. Wine
# needs an input that is not a terminal, and writes of text need a pipe.
set -eu
export WINEPREFIX="${WINEPREFIX:-$PWD/build/windows/user}" WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml=" PYTHONDONTWRITEBYTECODE=1
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
[ -x "$wine" ] || { echo "wine.sh: Wine is not installed (package wine64)" >&2; exit 127; }
"$wine" "$@" </dev/null 2>&1 | cat
