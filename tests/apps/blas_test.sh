#!/bin/sh
# blas_test.sh PROGRAM: whatever BLAS the machine offers, Ipopt gets the reference one where that is there, and `limit` keeps its bits
# beside the ATLAS that Ceres brings.
set -u
program=$1
folder=$(dirname "$(find /usr/lib -path '*/blas/libblas.so.3' 2>/dev/null | head -n 1)")
if [ ! -e "$folder/libblas.so.3" ]; then
  echo 'skipped: no reference BLAS; needs: libblas3'
  exit 77
fi
failed=0
# Loads what a run would: the loader prints it, and runs nothing.
loaded=$(LD_TRACE_LOADED_OBJECTS=1 LD_LIBRARY_PATH=${folder%/blas}/atlas "$program" | sed -n 's/.*libblas\.so\.3 => \([^ ]*\) .*/\1/p')
[ "$loaded" = "$folder/libblas.so.3" ] || { echo "Ipopt gets $loaded instead of $folder/libblas.so.3" && failed=1; }
case $(LD_TRACE_LOADED_OBJECTS=1 "$program") in
  *libceres* | *libatlas* | *libglog*) echo 'the program loads Ceres before anything is fitted' && failed=1 ;;
esac
if [ -e "${folder%/blas}/atlas/libblas.so.3" ]; then
  scene=$(mktemp) && trap 'rm -f "$scene"' EXIT
  cat >"$scene" <<'END'
structure = { kind = "plate", area = "1e-8 m^2", mass = "2.4e-9 kg", stiffness = "42 N/m" }
gap = { electrode = "3.8 um", contact = "2.6 um" }
electrode.main.fringing = "none"
contact = { model = "linear", stiffness = "1e5 N/m" }
waveform.main = { family = "step", level = "100 V" }
driver.main.max_voltage = "120 V"
simulate = { duration = "300 us", accuracy = 1e-4 }
END
  landing() { "$program" limit "$scene" --no-curves --quiet --json - | sed 's/"wall_s":[^,}]*//g'; }
  own=$(landing) beside_atlas=$(LD_LIBRARY_PATH=${folder%/blas}/atlas landing)
  [ -n "$own" ] && [ "$own" = "$beside_atlas" ] || { echo 'limit has other bits beside ATLAS' && failed=1; }
fi
exit "$failed"
