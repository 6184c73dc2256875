#!/usr/bin/env bash
# The main job: sets up, builds the program, fits both tables and leaves them with their figures in out/.
#   out/ltc_iso.json, out/ltc_aniso.json    the tables
#   out/ltc_iso.h,    out/ltc_aniso.h       the same as C/C++ headers
#   out/ltc_iso.ktx2, out/ltc_aniso.ktx2    the same as textures
#   out/ltc_iso.csv,  out/ltc_aniso.csv     one line for each entry
#   out/report.html,  out/report.json       their figures on one page; two of the minutes. Left out where npm could not
#                                           fetch the page's charting library
# With --tables-only no page. scripts/measure.sh measures more, and puts it on the page.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  '' | --tables-only) ;;
  *) echo "usage: scripts/fit.sh [--tables-only]" >&2; exit 2 ;;
esac
scripts/setup.sh
mkdir -p out
leftOut=
if [ -e build/report/charts/missing.txt ] && [ "${1:-}" != --tables-only ]; then
  leftOut="left out: the page of figures, out/report.html, as it has no charting library ($(cat build/report/charts/missing.txt))"
  echo "$leftOut"
fi
for kind in iso aniso; do
  echo "fitting out/ltc_$kind.json (half a minute at most)"
  build/ltcfit fit $kind -o out/ltc_$kind.json --resume --report out/ltc_$kind.csv
  build/ltcfit export out/ltc_$kind.json -o out/ltc_$kind.h
  build/ltcfit export out/ltc_$kind.json -o out/ltc_$kind.ktx2 --precision half
done
if [ "${1:-}" = --tables-only ]; then exit 0; fi
if [ -n "$leftOut" ]; then
  # no old page beside new tables
  rm -f out/report.html out/report.json
  echo "$leftOut"
  exit 0
fi
echo "measuring the tables for out/report.html (two minutes at most)"
build/ltcfit report out/ltc_iso.json out/ltc_aniso.json -o out/report.html
