#!/bin/sh
# arrows_test.sh COMPILER FILE ROOT "VISIBLE FOLDERS" -- "HIDDEN FOLDERS": with the include paths of a target, one a line in FILE,
# a header of each visible folder is found, and a source that includes one of a hidden folder does not compile.
set -u
compiler=$1 paths=$2 root=$3 visible=$4 hidden=${6:-}
failed=0

flags=
while IFS= read -r path; do
  [ -n "$path" ] && flags="$flags -I$path"
done <"$paths"

header_of() { (cd "$root" && ls "$1"/*.h | head -n 1); }

compiles() {  # SOURCE
  # shellcheck disable=SC2086
  printf '%s\n' "$1" | "$compiler" -std=c++20 $flags -fsyntax-only -x c++ - 2>&1
}

for folder in $visible; do
  header=$(header_of "$folder")
  said=$(compiles "#if !__has_include(\"$header\")
#error not found
#endif") || { echo "$header is not found, though the arrows lead to it: $said" && failed=1; }
done
for folder in $hidden; do
  header=$(header_of "$folder")
  if said=$(compiles "#include \"$header\""); then
    echo "an include of $header compiles, against the arrows" && failed=1
  else
    case $said in
      *"$header: No such file"* | *"'$header' file not found"*) ;;
      *) echo "an include of $header fails, but not because it is hidden: $said" && failed=1 ;;
    esac
  fi
done
exit "$failed"
