#!/usr/bin/env bash
# The main job: sets up, builds, fits the isotropic table and leaves it with its figures in out/.
#   out/ltc_iso.json     the table            out/ltc_iso.h       the same as a C/C++ header
#   out/ltc_iso.csv      one line an entry    out/ltc_iso.txt     its error: nodes, off-grid, extreme
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
mkdir -p out
build/ltcfit fit iso -o out/ltc_iso.json --report out/ltc_iso.csv "$@"
build/ltcfit export out/ltc_iso.json --format h -o out/ltc_iso.h
reference=${LTCFIT_REFERENCE_DIR:-../shared/reference}/ltc2017-1.npy
against=()
if [ -f "$reference" ]; then against=(--against "$reference"); fi
for points in nodes off-grid extreme; do
  build/ltcfit score out/ltc_iso.json --stored-as Minv --points $points "${against[@]}"
  echo
done > out/ltc_iso.txt
echo "error figures: out/ltc_iso.txt"
