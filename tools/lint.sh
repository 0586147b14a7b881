#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# lint.sh [--fix | CHECK]: run one check (cpp-format, cpp-checks, python-format, python-style, types, spelling,
# documents), or format everything in place.
set -eu
bin=build/venv/bin
cpp_files() { git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp'; }
case ${1:-} in
    cpp-format) cpp_files | xargs $bin/clang-format --dry-run --Werror ;;
    # By the compile commands of the native tests, which `make test` builds first.
    cpp-checks) git ls-files 'native/src/*.cpp' | xargs -P2 -n4 $bin/clang-tidy -p build/native --quiet ;;
    python-format) $bin/ruff format --check . ;;
    python-style) $bin/ruff check . ;;
    types) $bin/mypy ;;
    spelling) git ls-files --cached --others --exclude-standard | xargs -d '\n' $bin/codespell ;;
    documents) $bin/python tools/check_documents.py ;;
    --fix)
        cpp_files | xargs $bin/clang-format -i
        $bin/ruff check --fix .
        $bin/ruff format .
        git ls-files '*.md' ':!.github' | xargs $bin/python tools/wrap_documents.py
        ;;
    *) echo "lint.sh: name one check, or --fix" >&2; exit 2 ;;
esac
