#!/bin/bash
# Every test says where it runs: the end of a case's name is none that tests/CMakeLists.txt does not know, and no test is without a label.
#   labels_test.sh CTEST BUILD ENDINGS PROGRAM...      ENDINGS are separated by semicolons
set -u
ctest=$1 build=$2 endings=${3//;/|}
shift 3
failed=0

unknown() {  # LIST as --gtest_list_tests prints it: the cases whose names have an underscore before another end than these
  sed -nE 's/^  ([^ /]+).*/\1/p' <<<"$1" | grep _ | grep -vE "^[A-Za-z0-9]+_($endings)$"
}

sees() { unknown "$(printf 'Suite.\n  %s\n' "$1")" >/dev/null || { echo "does not see that $1 has an end that says nothing" && failed=1; }; }
lets() { ! unknown "$(printf 'Suite.\n  %s\n' "$1")" >/dev/null || { echo "refuses $1" && failed=1; }; }
sees 'LandsSoftly_xyz'
sees 'LandsSoftly_slowly'
sees 'LandsSoftly_xyz/3  # GetParam() = 4'
sees 'Lands_softly_slow'
lets 'LandsSoftly'
lets 'LandsSoftly/3  # GetParam() = a_b'
lets 'LandsSoftly_slow/mem_gold'

for program; do
  list=$("$program" --gtest_list_tests) || { echo "$program does not list its cases" && failed=1; }
  names=$(unknown "$list") && echo "${program##*/} has cases whose ends say nothing: $names" && failed=1
done

# ctest writes its log beside what it reads, where that of the tests that are running is.
here=$(mktemp -d) && trap 'rm -rf "$here"' EXIT
echo "subdirs([==[$build]==])" >"$here/CTestTestfile.cmake"
chosen() { "$ctest" --test-dir "$here" -N "$@" | tee "$here/list" | sed -n 's/^Total Tests: //p'; }
[ "$(chosen -LE .)" = 0 ] || { echo 'without a label:' && cat "$here/list" && failed=1; }
for label in quick sanitize sanitize-long; do
  [ "$(chosen -L "^$label$")" -gt 100 ] || { echo "hardly a test is labelled $label" && failed=1; }
done
exit "$failed"
