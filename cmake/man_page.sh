#!/bin/sh
# man_page.sh PROGRAM: the manual page softland(1), from what PROGRAM and each of its verbs print with --help.
set -eu
program=$1

help=$("$program" --help)
verbs=$(printf '%s\n' "$help" | awk '/^[A-Z]/ { inside = /^Verbs:/ } inside && /^  [a-z]/ { print $1 }')

# troff of one help text. Sections are lines like "Options:"; their indented lines are a term and what it means, or a command.
troff() {  # WHOLE: yes for the page itself, no for one of its verbs
  awk -v whole="$1" '
    function plain(text) {
      gsub(/\\/, "\\e", text)
      gsub(/-/, "\\-", text)
      sub(/^[.\047]/, "\\\\\\&&", text)
      return text
    }
    function term(text,    words, count, i, line) {  # names are bold, what stands for a value is slanted
      count = split(text, words, " ")
      for (i = 1; i <= count; ++i) {
        if (words[i] == "REQUIRED" || words[i] == "...") continue
        gsub(/,/, ", ", words[i])
        line = line (i > 1 ? " " : "") (words[i] ~ /^[A-Z|=]+$/ ? "\\fI" : "\\fB") plain(words[i]) "\\fR"
      }
      return line
    }
    function heading(name) { print (whole == "yes" ? ".SH " toupper(name) : ".PP\n" name ":") }

    /^Usage:/ { paragraph = 0; next }
    /^$/ { if (commands) print ".EE"; commands = paragraph = listing = 0; next }
    /^Verbs:/ { paragraph = 0; listing = 0; skipping = 1; next }
    /^[A-Z][a-z ]*:$/ {
      section = substr($0, 1, length($0) - 1)
      skipping = 0
      if (section ~ /^Example/) { heading(section); print ".EX"; commands = 1 }
      else { if (section !~ /^(Options|Positionals)$/ || whole == "yes") heading(section); listing = 1 }
      next
    }
    skipping && /^ / { next }
    commands { sub(/^  /, ""); print plain($0); next }
    listing && /^          / { sub(/^ */, ""); print plain($0); next }
    listing && /^  / {
      sub(/^  /, "")
      at = match($0, /  +/)
      print ".TP\n" term(at ? substr($0, 1, at - 1) : $0)
      if (at) print plain(substr($0, at + RLENGTH))
      next
    }
    { if (!paragraph) print ".PP"; paragraph = 1; print plain($0) }'
}

version=$("$program" --version)
cat <<END
.TH SOFTLAND 1 "" "$version" "User Commands"
.SH NAME
softland \\- lands MEMS switches softly
.SH SYNOPSIS
END
for verb in $verbs; do
  "$program" "$verb" --help | awk '/^Usage: / {
    gsub(/-/, "\\-")
    arguments = $0
    sub(/^Usage: softland [^ ]+ ?/, "", arguments)
    gsub(/OPTIONS/, "\\fIOPTION\\fR ...", arguments)
    gsub(/[A-Z][A-Z]+$|[A-Z][A-Z]+]$/, "\\fI&", arguments)
    print "\\fBsoftland " $3 "\\fR " arguments "\\fR\n.br"
  }'
done
echo '.SH DESCRIPTION'
printf '%s\n' "$help" | awk '/^Usage:/ { exit } { print }' | troff yes
echo '.SH VERBS'
for verb in $verbs; do
  printf '.SS %s\n' "$(printf '%s' "$verb" | sed 's/-/\\-/g')"
  "$program" "$verb" --help | troff no
done
printf '%s\n' "$help" | awk 'after { print } /^Usage:/ { after = 1 }' | troff yes
cat <<'END'
.SH SEE ALSO
README.md and docs/index.md, from which all pages of the manual are reached, in the folder of the documentation; the shipped scenes in share/softland/scenes.
END
