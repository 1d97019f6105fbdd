#!/bin/bash
# install_test.sh BUILD CXX: what `cmake --install` puts into a prefix works there: the program with its scenes, also after the prefix
# has moved, and the libraries for a user of CMake and for one of pkg-config.
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
missing=$(cd "$prefix/include/softland" && grep -rhoE '^#include "[^"]+"' . | sed 's/.*"\(.*\)"/\1/' | sort -u |
  while read -r header; do [ -f "$header" ] || echo "$header"; done)
[ -z "$missing" ] || fail "headers include what is not installed: $missing"

# shellcheck disable=SC2086
quietly "$compiler" $flags "$here/consumer/consumer.cc" -o "$work/by_pkg_config" $libraries
quietly cmake -G Ninja -S "$here/consumer" -B "$work/consumer" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_COMPILER="$compiler"
quietly cmake --build "$work/consumer"
for program in "$work/by_pkg_config" "$work/consumer/consumer"; do
  said=$("$program" "$scenes/mem-gold.toml")
  [[ $said =~ ^'first contact after 3'[0-9.]+' us'$ ]] || fail "$program says: $said"
done
