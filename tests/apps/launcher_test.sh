#!/bin/sh
# What the launcher does before, around and instead of a build:  launcher_test.sh PROJECT
# Compiles and installs nothing: it works on a project of one file, with stand-ins for the tools that note how they were called.
# shellcheck disable=SC2016,SC2030,SC2031 # the bodies of the stand-ins are quoted on purpose; each run has its own PATH
set -u
launcher=$1/softland
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
failed=0

project="$work/a project/softland"
tools="$work/tools"
mkdir -p "$project/base" "$project/cmake" "$tools" "$work/home" "$work/else where"
cp "$launcher" "$project/softland"
echo 'add_subdirectory(base)' >"$project/CMakeLists.txt"
touch "$project/CMakePresets.json" "$project/base/one.cc"

tool() {  # NAME: a stand-in whose body is standard input; it notes its arguments in calls
  { printf '#!/bin/sh\necho "%s $*" >>"%s/calls"\n' "$1" "$work" && cat; } >"$tools/$1"
  chmod +x "$tools/$1"
}
every_package_installed() {
  tool dpkg-query <<'BODY'
shift 2
for package; do echo "installed $package"; done
BODY
}
packages_missing() {  # NAME...
  tool dpkg-query <<BODY
shift 2
for package; do case " $* " in *" \$package "*) echo "not-installed \$package" ;; *) echo "installed \$package" ;; esac; done
BODY
}
tool cmake <<'BODY'
previous=
for word; do
  [ "$previous" != -B ] || { mkdir -p "$word/tests" && touch "$word/build.ninja"; }
  previous=$word
done
BODY
# Notes the files that it is asked for, and shows the build that $work/told tells, if it does.
tool ninja <<'BODY'
told=${0%/*}/../told
case $* in
  *' -n '*) [ ! -e "$told" ] || cat "$told/plan"; exit ;;
  *' -t deps') cat "$2/deps" 2>/dev/null; exit ;;
  *' -t query '*) [ "${5##*/}" != page.html ] || printf '%s:\n  outputs:\n    base/page.cc\n' "$5"; exit ;;
esac
[ ! -e "${2%/build/release}/base/broken" ] || { echo 'one.cc:1:1: error: broken'; exit 1; }
mkdir -p "$2/apps"
printf '#!/bin/sh\n[ "${1:-}" != status ] || exit "$2"\nprintf "in %%s:" "$PWD"; for word; do printf " <%%s>" "$word"; done; echo\n' >"$2/apps/softland.new"
chmod +x "$2/apps/softland.new"
[ ! -e "$2/slow" ] || sleep 1
mv "$2/apps/softland.new" "$2/apps/softland"
touch "$2/.ninja_log"
if [ -e "$told" ]; then
  cat "$told/times" >"$2/.ninja_log"
  cat "$told/lines"
fi
echo '[1/1 0.1] Linking CXX executable apps/softland'
BODY
tool id <<'BODY'
echo 1000
BODY
tool apt-get <<'BODY'
echo "E: no network" >&2; exit 100
BODY
tool sudo <<'BODY'
exit 100
BODY

tool ctest <<'BODY'
echo '100% tests passed, 0 tests failed out of 1'
BODY

run() {  # COMMAND...: its output in out and err, its exit status in status
  : >"$work/calls"
  (PATH="$tools:$PATH" HOME="$work/home" && unset XDG_CACHE_HOME SOFTLAND_NO_APT SOFTLAND_WERROR CI && export PATH HOME && "$@") \
    >"$work/out" 2>"$work/err" </dev/null
  status=$?
}

check() {  # SENTENCE CONDITION...: the condition is a command
  sentence=$1
  shift
  if "$@"; then
    echo "ok      $sentence"
  else
    failed=$((failed + 1))
    echo "FAILED  $sentence"
    echo "        status $status; $*"
    sed 's/^/        out: /' "$work/out"
    sed 's/^/        err: /' "$work/err"
  fi
}
out_is() { [ "$(cat "$work/out")" = "$1" ]; }
err_is() { [ "$(cat "$work/err")" = "$1" ]; }
err_has() { grep -qF -e "$1" "$work/err"; }
err_ends() { tail -n "$1" "$work/err" | head -n 1 | grep -qxF -e "$2"; }
made() { grep -qE '^ninja -C .* -j ' "$work/calls"; }
called() { grep -qe "^$1" "$work/calls"; }
not() { ! "$@"; }
status_is() { [ "$status" = "$1" ]; }

# Missing packages, not root.
packages_missing libnlopt-dev libfmt-dev
cd "$work/else where" || exit 1
run "$project/softland" simulate
check 'missing packages end with status 2' status_is 2
check 'missing packages are named' err_has 'missing packages: libnlopt-dev libfmt-dev'
check 'the exact command is printed' \
  err_has '  sudo apt-get update && sudo apt-get install -y --no-install-recommends libnlopt-dev libfmt-dev'
check 'nothing is installed without root' not called 'apt-get'
check 'sudo is never called' not called 'sudo'
check 'nothing is written when packages are missing' [ ! -e "$project/build" ]
check 'standard output stays empty' out_is ''

packages_missing librapidcheck-dev
run "$project/softland" test
check 'packages of the tests are needed by test' err_has 'missing packages: librapidcheck-dev'

# First build.
run "$project/softland" simulate 'my scene.toml' --set a=b
check 'packages of the tests are not needed by other verbs' status_is 0
check 'the first run tells that it builds' err_has 'softland: building (first run; compiles 1 files)'
check 'arguments and folder reach the program unchanged' out_is "in $work/else where: <simulate> <my scene.toml> <--set> <a=b>"
check 'the release preset is configured' called 'cmake --preset release'
check 'tests are not built' called 'ninja .* softland$'

# Up to date.
run "$project/softland" modes
check 'nothing is told when nothing is to be done' err_is ''
check 'no tool is called when nothing is to be done' [ ! -s "$work/calls" ]
run "$project/softland" status 4
check 'the exit status of the program is kept' status_is 4
sed -i 's/^processor=.*/processor=of another machine/' "$project/build/release/.options"
run "$project/softland" modes
check 'what was built for another processor is configured again, and asks it what it can' called 'cmake .*-U SOFTLAND_RUNS_\*'
check 'and built' made
run "$project/softland" modes
check 'once' [ ! -s "$work/calls" ]
ln -s "../a project/softland/softland" link
run ./link modes
check 'a link to the launcher works' out_is "in $work/else where: <modes>"
ln -s "$project/softland" optimize
run ./optimize --target bounce
check 'under the name optimize it optimizes' out_is "in $work/else where: <optimize> <--target> <bounce>"
for shell in dash bash; do
  command -v "$shell" >/dev/null || continue
  run "$shell" "$project/softland" modes
  check "$shell runs it" out_is "in $work/else where: <modes>"
done

# Sources change. What ninja, which goes by dates, would keep although its source has other contents must be gone before it runs.
build="$project/build/release"
change() { printf '%s\n' "$1" >"$project/$2"; }  # TEXT FILE
date_back() { touch -d '2020-01-01' "$@"; }
with_objects() {  # what is made of base/one.cc, of base/one.h and of base/page.html
  mkdir -p "$build/base"
  touch "$build/base/one.o" "$build/base/other.o" "$build/base/page.cc"
  printf '%s\n' 'base/one.o: #deps 2, deps mtime 1 (VALID)' "    $project/base/one.cc" '    views/base/base/one.h' '' \
    'base/other.o: #deps 1, deps mtime 1 (VALID)' '    /usr/include/none.h' '' >"$build/deps"
}
only_one_is_gone() { [ ! -e "$build/base/one.o" ] && [ -e "$build/base/other.o" ] && [ -e "$build/base/page.cc" ]; }
nothing_is_gone() { [ -e "$build/base/one.o" ] && [ -e "$build/base/other.o" ] && [ -e "$build/base/page.cc" ]; }
touch "$project/base/one.h" "$project/base/page.html"
run "$project/softland" modes
touch -d '2021-01-01' "$build/.ninja_log"
sleep 0.01
change 'int one;' base/one.cc
with_objects
run "$project/softland" modes
check 'a changed source is built' made
check 'an unchanged configuration is kept' not called cmake
check 'what is newer than its object is left to ninja' nothing_is_gone
touch "$project/base/one.cc"
run "$project/softland" modes
check 'a new date alone builds nothing' [ ! -s "$work/calls" ]
chmod 600 "$project/base/one.cc"
ln "$project/base/one.cc" "$work/hard link"
run "$project/softland" modes
check 'other rights or another link build nothing' [ ! -s "$work/calls" ]

mkdir "$work/release"
cp -a "$project/base" "$project/cmake" "$project/CMakeLists.txt" "$project/CMakePresets.json" "$work/release"
for way in tar cp rsync; do
  command -v "$way" >/dev/null || continue
  for file in one.cc one.h; do
    echo "int $way;" >"$work/release/base/$file"
    date_back "$work/release/base/$file"
    case $way in
      tar) (cd "$work/release" && tar cf - .) | (cd "$project" && tar xf -) ;;
      cp) cp -a "$work/release/." "$project" ;;
      rsync) rsync -ac "$work/release/" "$project" ;;
    esac
    with_objects
    run "$project/softland" modes
    check "$file of a release unpacked by $way with its old dates is built" made
    check 'and what was made of it is not kept' only_one_is_gone
    run "$project/softland" modes
    check 'once' [ ! -s "$work/calls" ]
  done
done
printf 'int Cp;\n' >"$work/same size"
date_back "$work/same size"
mv "$work/same size" "$project/base/one.cc"
with_objects
run "$project/softland" modes
check 'a source exchanged for an older one of the same size is built' made
check 'and its object is not kept' only_one_is_gone
change old base/page.html
date_back "$project/base/page.html"
with_objects
run "$project/softland" modes
check 'what a command makes of an older file is not kept either' [ ! -e "$build/base/page.cc" ]
change 'int new;' base/new.cc
date_back "$project/base/new.cc" "$project/base"
with_objects
run "$project/softland" modes
check 'an added file with an old date is built' made
rm "$project/base/new.cc"
date_back "$project/base"
run "$project/softland" modes
check 'a removed file is seen' made
for file in CMakeLists.txt CMakePresets.json cmake/a.cmake; do
  echo '# more' >>"$project/$file"
  date_back "$project/$file"
  run "$project/softland" modes
  check "an older $file is configured" called cmake
  check 'and built' made
done
cp -a "$build" "$work/copied" && rm -r "$build" && mv "$work/copied" "$build"
run "$project/softland" modes
check 'a copy of the build is taken as it is' [ ! -s "$work/calls" ]
rm "$build/.sources"
run "$project/softland" modes
check 'a build of unknown sources is built' made
mv "$project/base/one.cc" "$project/base/two.cc"
run "$project/softland" modes
check 'a renamed source is built' made
touch "$project/base/broken"
run "$project/softland" modes
check 'a failed build ends with status 5' status_is 5
check 'a failed build shows the end of its log' err_has 'one.cc:1:1: error: broken'
check 'the old program is not run after a failed build' out_is ''
run "$project/softland" modes
check 'nor when nothing has changed since' status_is 5
rm "$project/base/broken"
run "$project/softland" modes
check 'a repaired build recovers' out_is "in $work/else where: <modes>"
change 'int two;' base/two.cc
run env SOFTLAND_WERROR=ON "$project/softland" modes
check 'warnings become errors when asked' grep -qxF 'werror=ON' "$project/build/release/.options"

# Missing packages, root. The stand-in for apt-get installs by exchanging dpkg-query.
tool id <<'BODY'
echo 0
BODY
packages_missing libnlopt-dev
change 'int three;' base/two.cc
run "$project/softland" modes
check 'a failed installation ends with status 2' status_is 2
check 'a failed installation shows the reason' err_has 'E: no network'
check 'a failed installation prints the command' err_has '  apt-get update && apt-get install -y --no-install-recommends libnlopt-dev'
every_package_installed
mv "$tools/dpkg-query" "$work/dpkg-query"
packages_missing libnlopt-dev
tool apt-get <<BODY
[ "\$1" = update ] || mv "$work/dpkg-query" "$tools/dpkg-query"
echo 'pmstatus:libnlopt-dev:50.0000:Unpacking libnlopt-dev'
BODY
run "$project/softland" modes
check 'root installs what is missing and goes on' out_is "in $work/else where: <modes>"
check 'only what is missing is installed' called 'apt-get install .* libnlopt-dev$'
check 'progress is told' err_has 'softland: installing 50 %'

# Packages that only some tests want, root. The browser that this machine may have is kept out of the path.
mkdir "$work/basic"
for name in sh awk cat chmod cksum cmp cut date env find flock grep mkdir mv nproc readlink rm sed sha256sum sort tail tee touch tr uniq wc xargs; do
  ln -s "$(command -v "$name")" "$work/basic/$name"
done
only_basic_tools() {  # COMMAND...: run with the stand-ins and what the launcher itself calls
  run env PATH="$tools:$work/basic" "$@"
}
packages_missing chromium
only_basic_tools "$project/softland" test
check 'tests run without a browser' status_is 0
check 'a browser is not installed for a user' not called 'apt-get'
mv "$tools/dpkg-query" "$work/no-browser"
every_package_installed
mv "$tools/dpkg-query" "$work/dpkg-query"
mv "$work/no-browser" "$tools/dpkg-query"
only_basic_tools env CI=true "$project/softland" test
check 'continuous integration installs a browser' called 'apt-get install .* chromium$'

# How long a build takes. Objects of 14 s cost each when all is like it was measured; here they took 26 s.
every_package_installed
tool date <<BODY
[ "\$1" = +%s ] || exit 0
echo 30 >>"$work/clock"
echo \$((\$(wc -l <"$work/clock") * 151))
BODY
mkdir "$work/told"
printf 'Building CXX object %s/simd_closings_x.cc.o\n' a b c d e f g h >"$work/told/plan"
echo 'Linking CXX executable apps/softland' >>"$work/told/plan"
printf '0\t26000\t1\t%s/simd_closings_x.cc.o\t0\n' a b >"$work/told/times"
printf '26000\t52000\t1\t%s/simd_closings_x.cc.o\t0\n' c d >>"$work/told/times"
printf '[%s] Building CXX object %s/simd_closings_x.cc.o\n' '1/9 26.0' a '2/9 26.0' b '3/9 52.0' c '4/9 52.1' d >"$work/told/lines"
change 'int five;' base/two.cc
run env CMAKE_BUILD_PARALLEL_LEVEL=2 "$project/softland" modes
check 'a long build says how long it will take, measured on this machine' err_has 'softland: building: about 1 min 20 s more on this machine'
check 'and how far it is' err_has 'softland: building 50 %, about 50 s more'
check 'and how long it took' err_ends 1 'softland: built in 2 min 31 s'
check 'and no more' [ "$(wc -l <"$work/err")" = 3 ]
# Sources count by their size and folder: 19 s for 20 kB in base, which took 66 s here, leave 9 s, so 31 s, for 20 kB in model.
mkdir -p "$project/model" "$build/model/CMakeFiles/m.dir/Unity"
head -c 20000 /dev/zero >"$project/base/two.cc"
head -c 10000 /dev/zero | tee "$project/model/a.cc" >"$project/model/b.cc"
printf '#include "%s/model/%s.cc"\n' "$project" a "$project" b >"$build/model/CMakeFiles/m.dir/Unity/unity_0_cxx.cxx"
mkdir "$work/all" && mv "$work/told"/* "$work/all"
printf 'Building CXX object %s.o\n' base/CMakeFiles/b.dir/two.cc model/CMakeFiles/m.dir/Unity/unity_0_cxx.cxx >"$work/told/plan"
printf '0\t66500\t1\tbase/CMakeFiles/b.dir/two.cc.o\t0\n' >"$work/told/times"
echo '[1/3 66.5] Building CXX object base/CMakeFiles/b.dir/two.cc.o' >"$work/told/lines"
run env CMAKE_BUILD_PARALLEL_LEVEL=1 "$project/softland" modes
check 'the forecast weighs what is compiled as one by its sources' err_has 'softland: building: about 30 s more on this machine'
touch "$project/base/more.cc"
run env CMAKE_BUILD_PARALLEL_LEVEL=8 "$project/softland" modes
check 'and is no shorter than what takes longest' err_has 'softland: building: about 30 s more on this machine'
mv "$work/all"/* "$work/told"
sed -i 's/26000\t/2000\t/; s/52000\t/4000\t/' "$work/told/times"
sed -i 's/26\.0/2.0/; s/52\./4./' "$work/told/lines"
tool date </dev/null
change 'int six;' base/two.cc
for jobs in abc 0 -1 '2 3' 1.5 99999999999; do
  run env "CMAKE_BUILD_PARALLEL_LEVEL=$jobs" "$project/softland" modes
  check "$jobs compile jobs are refused" status_is 2
  check 'with the variable and what it must be' err_is "softland: CMAKE_BUILD_PARALLEL_LEVEL=$jobs: the compile jobs must be a whole number from 1 to 9999"
  check 'and nothing is built' not made
done
run env CMAKE_BUILD_PARALLEL_LEVEL=2 "$project/softland" modes
check 'a short one says nothing' err_is ''
rm -r "$work/told" "$tools/date"

# What did not run.
tool ctest <<'BODY'
mkdir -p "$2/Testing/Temporary"
echo '100% tests passed, 0 tests failed out of 6'
printf '\nThe following tests did not run:\n'
printf '\t  %d - apps.Page%d (Skipped)\n' 1 1 2 2 3 3 4 4 5 5
for word in '/a/b.h:58: Skipped' 'skipped: no browser; needs: chromium' 'skipped: no browser; needs: chromium' 'skipped: no terminal' \
  'skipped: no Slurm; needs: slurmctld munge root' 'Test Passed.'; do echo "$word"; done >"$2/Testing/Temporary/LastTest.log"
BODY
run "$project/softland" test -R 'apps'
check 'tests that did not run are told' err_has 'softland: 2 tests did not run: no browser (chromium)'
check 'each with its reason' err_has 'softland: 1 test did not run: no Slurm (slurmctld munge root)'
check 'also where nothing can be installed' err_has 'softland: 1 test did not run: no terminal'
check 'and where none is known' err_has "softland: 1 test did not run (log: $build/Testing/Temporary/LastTest.log)"
check 'the last word is the command that makes them run' err_ends 1 \
  'softland: to run them: apt-get update && apt-get install -y --no-install-recommends chromium slurmctld munge && ./softland test -R apps'
check 'tests that did not run are no failure' status_is 0
tool id <<'BODY'
echo 1000
BODY
run "$project/softland" test
check 'with sudo for those who need it' err_ends 1 \
  'softland: to run them: sudo apt-get update && sudo apt-get install -y --no-install-recommends chromium slurmctld munge && sudo ./softland test'
tool ctest <<'BODY'
echo '100% tests passed, 0 tests failed out of 1'
BODY
run "$project/softland" test
check 'nothing is told where all tests ran' err_is ''
check 'without arguments those run that continuous integration runs' grep -q '^ctest .* -LE ^(slow|slurm|pandas|python)\$$' "$work/calls"
: >"$work/calls"
run "$project/softland" test all --verbose
check 'or all of them' grep -q '^ctest .*-j [0-9]* --verbose$' "$work/calls"
: >"$work/calls"
run "$project/softland" test -R model
check 'or those that ctest is told' grep -q '^ctest .*-j [0-9]* -R model$' "$work/calls"
tool id <<'BODY'
echo 0
BODY

# Moved.
mv "$project" "$work/moved"
cd / || exit 1
run "$work/moved/softland" modes
check 'a moved project is configured again' called cmake
check 'a moved project works' out_is 'in /: <modes>'

# Two at once.
echo 'int four;' >"$work/moved/base/two.cc"
touch "$work/moved/build/release/slow"
: >"$work/calls"
PATH="$tools:$PATH" HOME="$work/home" "$work/moved/softland" modes >"$work/first" 2>&1 &
PATH="$tools:$PATH" HOME="$work/home" "$work/moved/softland" modes >"$work/second" 2>&1
wait
check 'two at once build once' [ "$(grep -c "^ninja .* -j" "$work/calls")" = 1 ]
check 'two at once both run' [ "$(cat "$work/first" "$work/second" | grep -c 'in /: <modes>')" = 2 ]

# The Python module.
project="$work/with a module"
mkdir -p "$project/base" "$project/cmake" "$project/python"
cp "$launcher" "$project/softland"
echo 'add_subdirectory(base)' >"$project/CMakeLists.txt"
touch "$project/CMakePresets.json" "$project/base/one.cc" "$project/python/module.cc"
every_package_installed
run "$project/softland" python
check 'python prints the line that makes the module importable' \
  out_is "export PYTHONPATH='$project/build/release/python'"'${PYTHONPATH:+:$PYTHONPATH}'
check 'python builds the module' called 'ninja .* python$'
check 'python configures it' called 'cmake .*-DSOFTLAND_PYTHON=ON'
run "$project/softland" python
check 'python builds once' [ ! -s "$work/calls" ]
echo changed >>"$project/python/module.cc"
run "$project/softland" modes
check 'a verb does not build the module' [ ! -s "$work/calls" ]
run "$project/softland" python
check 'python builds a changed module' called 'ninja .* python$'
run "$project/softland" python more
check 'python takes no arguments' status_is 2
packages_missing pybind11-dev
echo changed >>"$project/base/one.cc"
run "$project/softland" modes
check 'a verb does not need the packages of the module' status_is 0
run "$project/softland" python
check 'python names the packages that it needs' err_has 'missing packages: pybind11-dev'

# The manual.
run "$project/softland" manual more
check 'manual takes no arguments' status_is 2
packages_missing furo g++
run "$project/softland" manual
check 'manual names the packages that it needs, and no others' err_has 'missing packages: furo'
check 'manual builds nothing' [ ! "$(grep -E '^(cmake|ninja) ' "$work/calls")" ]

[ "$failed" = 0 ]
