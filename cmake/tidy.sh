#!/bin/bash
# tidy.sh [FOLDER ...]: clang-tidy 16 over the sources of the folders (all by default) with the rules of .clang-tidy, several files as one as the
# preset `clang` compiles them. Prints every finding once. Needs clang-16 and clang-tidy-16. Exit status: 0 nothing found, 1 findings.
set -u
cd "$(dirname "$0")/.." || exit 5
[ $# -gt 0 ] || set -- base sampling store integrators waveforms exchange model objectives config optimizers studies reports apps

log=$(mktemp)
trap 'rm -f "$log"' EXIT
{ cmake --preset clang && cmake --build --preset clang --target document/page_files.cc; } >"$log" 2>&1 || { tail -n 20 "$log" && exit 5; }
printf 'build/clang/%s\n' "$@" | xargs -I{} find {} -path '*/Unity/*.cxx' -print0 |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-16 -p build/clang --quiet >"$log" 2>/dev/null
status=$?
grep -aE '(warning|error): ' "$log" | sort -u | sed "s,$PWD/,,; s,build/clang/views/[a-z]*/,,"
[ "$status" = 0 ]
