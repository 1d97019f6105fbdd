#!/bin/sh
# lanes_symbols_test.sh LIBRARY: code for special vector instructions leaves no function behind that the linker may give to the rest of
# the program, which has to run without them: every function that it could share is about lanes of that width.
library=$1
shared() {  # OBJECT PATTERN: what others may be linked to, but for what has the pattern in its name
  nm -C "$library" | awk -v object="$1.cc.o:" -v pattern="$2" '
    /^[^ ]*:$/ { inside = $0 == object }
    inside && / [WVu] / { count++; if (index($0, pattern) == 0 && $0 !~ /DW\.ref\./) print }
    END { if (count == 0) print object " has nothing to look at" }'
}
found=$(shared simd_closings_avx2 '_VecBuiltin<32>'; shared simd_closings_avx512 '_VecBltnBtmsk<64>')
[ -z "$found" ] && exit 0
printf 'may be linked into the rest of the program:\n%s\n' "$found"
exit 1
