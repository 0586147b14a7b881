#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# fuzz.sh BUILD_FOLDER SECONDS: run each fuzz target for this long, starting with the committed inputs. New inputs are
# stored under BUILD_FOLDER/corpus; a failing input is written to BUILD_FOLDER and ends the run.
set -eu
build=$1
seconds=$2
for program in "$build"/native/fuzz/fuzz_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    target=$(basename "$program" | sed 's/^fuzz_//')
    echo "== $target, $seconds s"
    mkdir -p "$build/corpus/$target"
    "$program" "$build/corpus/$target" "native/fuzz/corpus/$target" -max_total_time="$seconds" -max_len=512 -len_control=0 \
        -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 -verbosity=0 -artifact_prefix="$build/$target-"
done
