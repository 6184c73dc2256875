#!/usr/bin/env bash
# The main job: sets up, builds, fits both tables and leaves them with their figures in out/.
#   out/ltc_iso.json, out/ltc_aniso.json    the tables
#   out/ltc_iso.h,    out/ltc_aniso.h       the same as C/C++ headers
#   out/ltc_iso.csv,  out/ltc_aniso.csv     one line an entry
#   out/ltc_iso.txt,  out/ltc_aniso.txt     their error: nodes, off-grid, extreme
#   out/shading_iso/, out/shading_aniso/    scenes shaded with them in OpenGL, next to the true light
#   out/report.html,  out/report.json       all of it on one page, with error against run time and the stability of the fitters
#                                           (out/pareto_iso.json, out/pareto_aniso.json, out/stability.json)
# With --tables-only nothing but the tables, headers and .csv files: the measurements take nine of the ten minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1:-} in
  '' | --tables-only) ;;
  *) echo "usage: scripts/fit.sh [--tables-only]" >&2; exit 2 ;;
esac
scripts/setup.sh
mkdir -p out
references=${LTCFIT_REFERENCE_DIR:-../shared/reference}
score() { # TABLE REFERENCE POINTS-A-SET OPTIONS...
  local against=()
  if [ -f "$references/$2" ]; then against=(--against "$references/$2"); fi
  for points in nodes off-grid extreme; do
    build/ltcfit score "out/$1.json" --points $points --count "$3" "${@:4}" "${against[@]}"
    echo
  done > "out/$1.txt"
  echo "error figures: out/$1.txt"
}
for kind in iso aniso; do
  build/ltcfit fit $kind -o out/ltc_$kind.json --resume --report out/ltc_$kind.csv
  build/ltcfit export out/ltc_$kind.json --format h -o out/ltc_$kind.h
done
if [ "${1:-}" = --tables-only ]; then exit 0; fi
score ltc_iso ltc2017-1.npy 512 --stored-as Minv
score ltc_aniso kt2022-alpha-lambda-theta-phi.npy 512

for kind in iso aniso; do build/ltcfit pareto --table $kind -o out/pareto_$kind.json > out/pareto_$kind.txt; done
# 3: a limit is broken, which the page shows
build/ltcfit stability -o out/stability.json > out/stability.txt || [ $? -eq 3 ]
shading=()
check() { # TABLE REFERENCE
  local against=()
  if [ -f "$references/$2" ]; then against=(--against "$references/$2"); fi
  build/ltcfit check-gl "out/ltc_$1.json" "${against[@]}" --cost -o "out/shading_$1" > "out/shading_$1.txt"
  shading+=(--shading "out/shading_$1/shading.json")
}
check iso ltc2017-1.npy
check aniso kt2022-alpha-lambda-theta-phi.npy
against=()
for reference in ltc2017-1.npy kt2022-alpha-lambda-theta-phi.npy; do
  if [ -f "$references/$reference" ]; then against+=(--against "$references/$reference"); fi
done
build/ltcfit report out/ltc_iso.json out/ltc_aniso.json "${against[@]}" --pareto out/pareto_iso.json \
  --pareto out/pareto_aniso.json --stability out/stability.json "${shading[@]}" -o out/report.html
