#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# wine.sh PROGRAM ARGUMENT...: run a Windows program under Wine, for a user of its own in build/windows/user. Under Wine,
# programs of the console need an empty input, and a pipe as their output.
set -eu
wine=$(command -v wine64 || echo /usr/lib/wine/wine64)
[ -x "$wine" ] || { echo "wine.sh: Wine is not installed (package wine64)" >&2; exit 127; }
export WINEPREFIX="${WINEPREFIX:-$PWD/build/windows/user}" WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml="
export PYTHONDONTWRITEBYTECODE=1
mkdir -p "$(dirname "$WINEPREFIX")"
code=$(mktemp)
{ "$wine" "$@" </dev/null 2>&1 && echo 0 >"$code" || echo $? >"$code"; } | cat
result=$(cat "$code")
rm "$code"
exit "$result"
