#!/usr/bin/env bash
# Makes everything in data/ again: the default tables, their exports and checksums. Two commits with the same bytes here
# ship the same tables.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
for kind in iso aniso; do
  build/ltcfit fit $kind -q -o data/ltc_$kind.json
  build/ltcfit export -q data/ltc_$kind.json -o data/ltc_$kind.h
  build/ltcfit export -q data/ltc_$kind.json -o data/ltc_$kind.ktx2 --precision half
done
build/ltcfit export -q data/ltc_iso.json --format chebyshev -o data/ltc_iso
build/ltcfit refine -q data/ltc_aniso.json -o data/ltc_aniso_refined.json
build/ltcfit export -q data/ltc_aniso_refined.json -o data/ltc_aniso_refined.h
build/ltcfit export -q data/ltc_aniso_refined.json -o data/ltc_aniso_refined.ktx2 --precision half
(cd data && sha256sum ltc_* > SHA256SUMS)
