#!/bin/bash
# from_help_test.sh PROGRAM ROOT: the manual page and the completions hold every verb and every option that --help prints.
set -u
program=$1 root=$2
failed=0

fail() { echo "$*" && failed=1; }
options_of() { "$program" "$@" --help | sed -nE '/^Options:/,/^$/s/^  (-[^ ]+).*/\1/p' | tr ',' '\n'; }

page=$(sh "$root/cmake/man_page.sh" "$program") || fail 'the manual page cannot be made'
page=$(printf '%s\n' "$page" | sed -E 's/\\f[BIR]//g; s/\\-/-/g')
section_of() {  # VERB: its part of the page, or the options of the program
  printf '%s\n' "$page" | awk -v verb="$1" '/^\.S[SH]/ { inside = verb == "" ? $0 == ".SH OPTIONS" : $0 == ".SS " verb } inside'
}

completions=$(bash "$root/cmake/bash_completion.sh" "$program") || fail 'the completions cannot be made'
eval "$completions"
# shellcheck disable=SC2317
compopt() { :; }  # bash has it inside a completion only
completed() {  # WORD ...: what completes the last one
  COMP_WORDS=(softland "$@") COMP_CWORD=$# COMPREPLY=()
  _softland
  printf '%s\n' "${COMPREPLY[@]}"
}
offers() { grep -qxF -e "$1" <<<"$2" || fail "no completion '$1' of '$3'"; }

verbs=$("$program" --help | awk '/^[A-Z]/ { inside = /^Verbs:/ } inside && /^  [a-z]/ { print $1 }')
[ "$(wc -w <<<"$verbs")" -ge 10 ] || fail "not all verbs are found in --help: $verbs"
for verb in '' $verbs; do
  [ -z "$verb" ] || offers "$verb" "$(completed '')" softland
  [ -n "$(section_of "$verb")" ] || fail "the manual page has no section '$verb'"
  # shellcheck disable=SC2086
  options=$(options_of $verb)
  [ -n "$options" ] || fail "no options of '$verb' are found in --help"
  for option in $options; do
    section_of "$verb" | grep -qE -e "(^|, )$option( |,|\$)" || fail "the manual page has no '$option' of '$verb'"
    # shellcheck disable=SC2086
    offers "$option" "$(completed $verb -; [ -n "$verb" ] || completed '')" "softland $verb"
  done
done

# Values too: those the text names, and files.
for value in bounce settling rebound count impact energy; do offers "$value" "$(completed optimize --target '')" --target; done
for value in auto bobyqa cma-es; do offers "$value" "$(completed optimize --target bounce --optimizer '')" --optimizer; done
for value in cantilever two-electrodes; do offers "$value" "$(completed new '')" new; done
offers spice-pwl "$(completed export out --format = sp)" '--format='
cd "$root" || exit 1
offers scenes/mem-gold.toml "$(completed simulate scenes/mem-g)" 'a scene'
offers scenes "$(completed simulate sce)" 'a folder'
[ -z "$(completed simulate LICEN)" ] || fail 'LICENSE is offered as a scene'
offers LICENSE "$(completed simulate scenes/mem-gold.toml --json LICEN)" --json

if command -v groff >/dev/null; then
  said=$(sh "$root/cmake/man_page.sh" "$program" | groff -man -Tutf8 -ww -z 2>&1)
  [ -z "$said" ] || fail "groff complains: $said"
fi
exit "$failed"
