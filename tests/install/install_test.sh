#!/bin/bash
# install_test.sh BUILD CXX: what `cmake --install` puts into a prefix works there: the program with its scenes,
# also after the prefix has moved, the libraries for a user of CMake and for one of pkg-config, and the examples, which are built there.
set -u
build=$1 compiler=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "$*" && exit 1; }
quietly() { "$@" >"$work/log" 2>&1 || { tail -n 30 "$work/log" && fail "failed: $*"; }; }

quietly cmake --install "$build" --prefix "$work/first"
prefix=$work/moved
mv "$work/first" "$prefix"
found() { [ -n "$(find "$prefix" -path "$prefix/$1")" ] || fail "not installed: $1"; }
for file in share/softland/scenes/mem-gold.toml share/man/man1/softland.1 share/bash-completion/completions/softland \
  'share/doc/*/LICENSE' 'share/doc/*/LICENSE.uPlot' 'share/doc/*/CHANGELOG.md' 'share/doc/*/CITATION.cff' 'share/doc/*/docs/scene.md'; do
  found "$file"
done

# The scenes are those of the prefix, not those of the tree that the program was built from.
scenes=$prefix/share/softland/scenes
sed -i 's/^title = .*/title = "of this prefix"/' "$scenes"/*.toml
"$prefix/bin/softland" new | grep -qx 'title = "of this prefix"' || fail 'the program prints another scene than the installed one'
mkdir "$work/run"
said=$(cd "$work/run" && "$prefix/bin/softland" optimize --actuator pzt --robust none --budget 2 --quiet --set simulate.accuracy=1e-3 --set structure.modes=2 --json - 2>&1)
[[ $said == *'"title": "of this prefix"'* ]] || fail "the program searches in another scene than the installed one: $said"

# Whatever a header includes by its path is there.
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name softland.pc)")
export PKG_CONFIG_PATH
flags=$(pkg-config --cflags softland) || fail 'pkg-config does not find softland'
libraries=$(pkg-config --libs softland)
missing=$(cd "$prefix/include" && grep -rhoE '^#include "[^"]+"' . | sed 's/.*"\(.*\)"/\1/' | sort -u |
  while read -r header; do [ -f "$header" ] || echo "$header"; done)
[ -z "$missing" ] || fail "headers include what is not installed: $missing"

# A user's own folders and files of the same names are in nobody's way.
mkdir -p "$work/own/model" "$work/own/studies"
echo '#error a header of softland includes one of the user' | tee "$work/own/model/switch.h" "$work/own/studies/simulate.h" >"$work/own/version.h"
# shellcheck disable=SC2086
quietly "$compiler" "-I$work/own" $flags "$here/consumer/consumer.cc" -o "$work/by_pkg_config" $libraries
quietly cmake -G Ninja -S "$here/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler"
quietly cmake --build "$work/consumer"
for program in "$work/by_pkg_config" "$work/consumer/consumer"; do
  said=$("$program" "$scenes/mem-gold.toml")
  [[ $said =~ ^'first contact after 3'[0-9.]+' us'$ ]] || fail "$program says: $said"
done

# All that softland/softland.h lists, and the errors that it throws.
# shellcheck disable=SC2086
quietly "$compiler" $flags "$here/consumer/device.cc" -o "$work/device_by_pkg_config" $libraries
sed 's/^contact = .*/contact = "9 um"/' "$scenes/mem-gold.toml" >"$work/wrong.toml"
for program in "$work/device_by_pkg_config" "$work/consumer/device"; do
  said=$("$program" "$scenes/mem-gold.toml")
  [[ $said =~ ^'closed '[1-9][0-9]*' times'$ ]] || fail "$program says: $said"
  [ "$("$program" "$work/wrong.toml")" = gap.contact ] || fail "$program does not tell which key is wrong"
done

# The examples, as they are installed.
examples=$(find "$prefix/share/doc" -type d -name examples)
quietly cmake -G Ninja -S "$examples" -B "$work/examples" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release
quietly cmake --build "$work/examples" -j 2
says() {  # "LINE" EXAMPLE SCENE...: prints that line
  line=$1 example=$2
  shift 2
  said=$("$work/examples/$example" "$@") || fail "$example ends with $?: $said"
  grep -qE "$line" <<<"$said" || fail "$example says: $said"
}
says '^First contact +3\.42[0-9]*e-05 s' 01_close "$scenes/mem-gold.toml"
says '^ +76\.5 +7\.10 +11\.98 +17\.63' 02_pull_in_map
says '^two-electrodes +- +2\.61 um +16\.3 us' 03_search "$scenes/two-electrodes.toml"
says '^without a rebound, and better than the plain step$' 04_own_objective "$scenes/mem-gold.toml"
says '^swell +95 % of 200 devices' 05_own_waveform "$scenes/mem-gold.toml"
