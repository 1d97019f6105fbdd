#!/bin/bash
# The sources of the Python module compile, checked as one unit without code: bash compiles_test.sh COMPILER PYTHON OPTIONS ROOT. OPTIONS is a file with
# one option of the compiler a line. What the linker or Python finds is left to the tests labelled python, which need the module itself.
set -u
compiler=$1 python=$2 options=$3 root=$4

mapfile -t options < <(grep . "$options")
include=$("$python" -c 'import sysconfig; print(sysconfig.get_path("include"))' 2>/dev/null)
if [ ! -e "$include/Python.h" ] || ! "$compiler" -I"$include" -include pybind11/pybind11.h -fsyntax-only -x c++ -E /dev/null >/dev/null 2>&1; then
  echo 'skipped: no pybind11; needs: python3-dev pybind11-dev'
  exit 77
fi
sources=("$root"/python/*.cc)
[ -e "${sources[0]}" ] || { echo "no sources in $root/python" && exit 1; }
printf '#include "%s"\n' "${sources[@]}" |
  "$compiler" -std=c++20 "${options[@]}" -isystem "$include" "-DSOFTLAND_SCENES=\"$root/scenes\"" -fsyntax-only -x c++ -
