# SPDX-License-Identifier: GPL-3.0-or-later
# Source this file: `open_archive deb|deb-src SUITE` defines an apt() that reads Debian's archive into $work, a separate
# folder that is removed at the end. Needs no privileges, and leaves the system's lists unchanged. $apt_options are passed
# to every call.

work=
fail() { echo "$(basename "$0"): $1" >&2; exit 1; }

open_archive() {
    command -v apt-get >/dev/null || fail "apt-get is missing"
    keyring=/usr/share/keyrings/debian-archive-keyring.gpg
    [ -f "$keyring" ] || fail "$keyring is missing: install the package debian-archive-keyring"
    work=${work:-$(mktemp -d)}
    trap 'rm -rf "$work"' EXIT
    chmod 755 "$work"  # apt downloads as a separate user if possible
    mkdir -p "$work/lists/partial" "$work/cache/archives/partial"
    echo "$1 [signed-by=$keyring] http://deb.debian.org/debian $2 main" >"$work/sources.list"
    apt update || { cat "$work/log" >&2; fail "the list of packages of Debian $2 could not be read"; }
}

apt() {
    apt-get -o Dir::Etc::sourcelist="$work/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$work/lists" -o Dir::Cache="$work/cache" -o APT::Sandbox::User="$(id -un)" \
        -o Acquire::Retries=5 -o Acquire::Languages=none ${apt_options:-} "$@" >"$work/log" 2>&1
}
