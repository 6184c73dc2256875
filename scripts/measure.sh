#!/usr/bin/env bash
# Measures what scripts/fit.sh makes, as far as it is there, and makes the rest first (ten minutes on two cores):
#   out/ltc_iso.txt,     out/ltc_aniso.txt      error of the tables: nodes, off-grid, extreme
#   out/pareto_iso.json, out/pareto_aniso.json  error against run time of the fitters
#   out/stability.json                          stability of the fitters
#   out/shading_iso/,    out/shading_aniso/     scenes shaded in OpenGL with the tables, next to the true light
#   out/report.html,     out/report.json        all of it on one page
# Against the published tables where they are at ../shared/reference or $LTCFIT_REFERENCE_DIR. What this machine cannot
# measure, for want of OpenGL or of the page's charting library, is left out and named.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -eq 0 ] || { echo "usage: scripts/measure.sh" >&2; exit 2; }
scripts/fit.sh --tables-only
references=${LTCFIT_REFERENCE_DIR:-../shared/reference}
leftOut=()
leaveOut() { leftOut+=("left out: $*"); echo "left out: $*"; }
if [ -e build/report/charts/missing.txt ]; then
  leaveOut "the page of figures, out/report.html, as it has no charting library ($(cat build/report/charts/missing.txt))"
fi
page=()
declare -A published=([iso]=ltc2017-1.npy [aniso]=kt2022-alpha-lambda-theta-phi.npy)
declare -A stored=([iso]="--stored-as Minv" [aniso]="")
for kind in iso aniso; do
  against=()
  if [ -f "$references/${published[$kind]}" ]; then against=(--against "$references/${published[$kind]}"); fi
  page+=("${against[@]}")
  echo "error figures: out/ltc_$kind.txt (a minute)"
  for points in nodes off-grid extreme; do
    # shellcheck disable=SC2086
    build/ltcfit score out/ltc_$kind.json --points $points --count 512 ${stored[$kind]} "${against[@]}"
    echo
  done > out/ltc_$kind.txt
  echo "error against run time: out/pareto_$kind.json (two minutes)"
  build/ltcfit pareto --table $kind -o out/pareto_$kind.json > out/pareto_$kind.txt
  page+=(--pareto "out/pareto_$kind.json")
  echo "shading: out/shading_$kind/ (a minute)"
  status=0
  build/ltcfit check-gl out/ltc_$kind.json "${against[@]}" --cost -o out/shading_$kind > out/shading_$kind.txt || status=$?
  case $status in
    0) page+=(--shading "out/shading_$kind/shading.json") ;;
    1) leaveOut "shading with out/ltc_$kind.json, for the reason above" ;;
    *) exit $status ;;
  esac
done
echo "stability of the fitters: out/stability.json (two minutes)"
# 3: a limit is broken, which the page shows
build/ltcfit stability -o out/stability.json > out/stability.txt || [ $? -eq 3 ]
page+=(--stability out/stability.json)
if ! [ -e build/report/charts/missing.txt ]; then
  echo "the page: out/report.html (two to four minutes)"
  build/ltcfit report out/ltc_iso.json out/ltc_aniso.json "${page[@]}" -o out/report.html
fi
for what in "${leftOut[@]}"; do echo "$what"; done
