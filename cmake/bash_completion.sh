#!/bin/sh
# bash_completion.sh PROGRAM: completions for bash, from what PROGRAM and each of its verbs print with --help.
set -eu
program=$1

verbs=$("$program" --help | awk '/^[A-Z]/ { inside = /^Verbs:/ } inside && /^  [a-z]/ { print $1 }')

# Shell cases of one verb: "VERB OPTION") for what follows an option, "VERB") for its positional and its options.
cases() {  # VERB
  "$program" "$1" --help | awk -v verb="$1" '
    function names(text) {  # "what is meant: a (default), b or c; more": a b c
      sub(/;.*/, "", text)
      sub(/^[^:]*: /, "", text)
      gsub(/ *\([^)]*\)/, "", text)
      gsub(/, | or /, " ", text)
      return text
    }
    function reply(word, text) {
      if (word == "FILE" || word == "RESULT") return "files"
      if (word == "SCENE") return "files toml"
      if (word == "FOLDER") return "folders"
      if (word == "KIND" || word == "NAME") return "words \"" names(text) "\""
      return ":"
    }
    /^[A-Z][a-z]*:$/ { section = $1; next }
    !/^  / { section = "" }
    section == "Positionals:" {
      text = $0
      sub(/^ *[A-Z]+ (REQUIRED)? */, "", text)
      argument = reply($1, text)
    }
    section == "Options:" && $1 ~ /^-/ {
      count = split($1, spellings, ",")
      for (i = 1; i <= count; ++i) options = options " " spellings[i]
      option = spellings[count]
      if ($2 !~ /^[A-Z|=]+$/) next
      text = $0
      sub(/^ *[^ ]+ +[^ ]+( \.\.\.)? */, "", text)
      follows[option] = reply($2, text)
    }
    section == "Optimizers:" { others = others " " $1 }
    END {
      if ("--optimizer" in follows) follows["--optimizer"] = "words \"" substr(others, 2) "\""
      for (option in follows) print "    \"" verb " " option "\") " follows[option] " ;;" | "sort"
      close("sort")
      print "    \"" verb " \"*) if [[ $word == -* ]]; then words \"" substr(options, 2) "\"; else " argument "; fi ;;"
    }'
}

cat <<'END'
# Completions of softland for bash, made from its --help.
_softland() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} verb=
  [[ $COMP_CWORD -gt 1 ]] && verb=${COMP_WORDS[1]}
  [[ $word == '=' ]] && word=
  [[ $before == '=' ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  words() { mapfile -t COMPREPLY < <(compgen -W "$1" -- "$word"); }
  folders() { compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$word"); }
  files() {  # ENDING: those that end so, and folders
    compopt -o filenames
    if [[ ${1-} ]]; then
      mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X "!*.$1" -- "$word")
    else
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
    fi
  }
  COMPREPLY=()
  case "$verb $before" in
END
for verb in $verbs; do cases "$verb"; done
printf '    " "*) words "%s -h --help --version" ;;\n' "$(printf '%s\n' "$verbs" | tr '\n' ' ' | sed 's/ $//')"
cat <<'END'
  esac
  unset -f words folders files
}
complete -F _softland softland
END
