#!/bin/sh
# commands_page.sh PROGRAM DOCUMENT: prints DOCUMENT (docs/commands.md) with its table of exit statuses and all that follows its line "## Verbs"
# made again from what PROGRAM and each of its verbs print with --help. An option that three verbs and more word alike is explained once.
set -eu
program=$1 document=$2

help=$("$program" --help)
verbs=$(printf '%s\n' "$help" | awk '/^[A-Z]/ { inside = /^Verbs:/ } inside && /^  [a-z]/ { print $1 }')

statuses=$(printf '%s\n' "$help" | awk '/^[A-Z]/ { inside = /^Exit status:/ } inside && /^  [0-9]/ { status = $1; sub(/^ *[0-9]+ +/, ""); print "| " status " | " $0 " |" }')
awk -v statuses="$statuses" '
  made && /^\|/ { next }
  { made = /^\| exit status \|/; print }
  made { print "|---|---|\n" statuses }
  /^## Verbs$/ { exit }' "$document"
printf '\n| verb | what it does |\n|---|---|\n'
printf '%s\n' "$help" | awk '/^[A-Z]/ { inside = /^Verbs:/ } inside && /^  [a-z]/ { verb = $1; sub(/^ *[^ ]+ +/, ""); print "| `" verb "` | " $0 " |" }'

for verb in $verbs; do
  printf '@verb %s\n' "$verb"
  "$program" "$verb" --help
done | awk '
  function plain(text,    said) {  # for Markdown; options are code, or their dashes would become one
    gsub(/&/, "\\&amp;", text)
    gsub(/</, "\\&lt;", text)
    gsub(/\*/, "\\\\*", text)
    while (match(text, /--[a-z][a-z-]*/)) {
      said = said substr(text, 1, RSTART - 1) "`" substr(text, RSTART, RLENGTH) "`"
      text = substr(text, RSTART + RLENGTH)
    }
    return said text
  }
  function row(term, meaning,    needed) {
    needed = sub(/ REQUIRED/, "", term)
    return "- `" term "`" (needed ? " (required)" : "") ": " plain(meaning)
  }
  function close_entry() {  # keeps the option or argument that has been read
    if (term == "") return
    if (term !~ /^-h/) { entry[verb, ++entries[verb]] = row(term, meaning); ++verbs_with[row(term, meaning)] }
    term = ""
  }
  function keep(line) { after[verb] = after[verb] line "\n" }
  function close_commands() { if (commands) keep("```"); commands = 0 }

  /^@verb / { close_entry(); close_commands(); verb = $2; order[++count] = verb; section = "about"; next }
  /^Usage: / { usage[verb] = substr($0, 8); section = ""; next }
  section == "about" { next }  # the table says it
  /^(Positionals|Options):$/ { close_entry(); section = "entries"; next }
  /^[A-Z][a-z]*:$/ {
    close_entry()
    close_commands()
    if ($0 ~ /^Example/) { keep("\n```sh"); commands = 1; section = "commands" }
    else { keep("\n" $0 "\n"); section = "list" }
    next
  }
  /^$/ { close_entry(); close_commands(); section = ""; keep(""); next }
  section == "entries" && /^          / { sub(/^ +/, ""); meaning = meaning (meaning == "" ? "" : " ") $0; next }
  section == "entries" && /^  / {
    close_entry()
    sub(/^  /, "")
    if (match($0, /  +/)) { term = substr($0, 1, RSTART - 1); meaning = substr($0, RSTART + RLENGTH) }
    else { term = $0; meaning = "" }
    next
  }
  section == "list" && /^  / { sub(/^  /, ""); at = match($0, /  +/); keep(row(substr($0, 1, at - 1), substr($0, at + RLENGTH))); next }
  section == "commands" && /^  / { sub(/^  /, ""); keep($0); next }
  { close_commands(); if (section != "text") keep(""); section = "text"; keep(plain($0)) }

  END {
    close_entry()
    close_commands()
    print "\n## Options of several verbs\n"
    for (v = 1; v <= count; ++v)
      for (e = 1; e <= entries[order[v]]; ++e) {
        line = entry[order[v], e]
        if (verbs_with[line] >= 3 && line ~ /^- `-/ && !told[line]++) print line
      }
    print "\n## Each verb"
    for (v = 1; v <= count; ++v) {
      verb = order[v]
      print "\n### " verb "\n"
      too = own = ""
      for (e = 1; e <= entries[verb]; ++e) {
        line = entry[verb, e]
        if (line in told) { split(line, part, /[` ]+/); too = too (too == "" ? "" : ", ") "`" part[2] "`" }
        else own = own line "\n"
      }
      print "`" usage[verb] "`" (too == "" ? "" : "; besides, as above: " too)
      if (own != "") printf "\n%s", own
      text = after[verb]
      gsub(/\n\n\n+/, "\n\n", text)
      sub(/^\n+/, "", text)
      sub(/\n+$/, "", text)
      if (text != "") print "\n" text
    }
  }'
