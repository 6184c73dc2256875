#!/usr/bin/env bash
set -euo pipefail
cd "$(dirname "$0")/.."

usage() {
  cat <<'TEXT'
usage: scripts/bench.sh [--filter REGEX] [--repetitions N] [--against FILE] [--renew]

Sets up, runs the benchmarks (under two minutes of CPU), prints for each the median CPU time, its spread and the
error reached, and compares with a baseline: scripts/bench_compare.py --help says how. The result is left in
out/bench.json.

  --filter REGEX     only benchmarks whose name matches (and the calibration that they are compared by)
  --repetitions N    of each benchmark, 3 or more; they are interleaved (default: 9)
  --against FILE     result to compare with (default: data/bench/baseline.json)
  --renew            write the result to data/bench/baseline.json instead of comparing with it. On a calm machine,
                     after a change that is meant to move the figures

Exit code: 0 nothing flagged, 1 failure, 2 bad option or input, 3 something got slower or less exact.
TEXT
}
refuse() { echo "bench.sh: $*" >&2; exit 2; }

filter=
repetitions=9
baseline=data/bench/baseline.json
renew=
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) usage; exit 0 ;;
    --renew) renew=1 ;;
    --filter | --repetitions | --against)
      [ $# -ge 2 ] || refuse "$1 needs a value"
      case $1 in --filter) filter=$2 ;; --repetitions) repetitions=$2 ;; --against) baseline=$2 ;; esac
      shift ;;
    *) refuse "unknown option $1 (--help lists them)" ;;
  esac
  shift
done
[[ $repetitions =~ ^[0-9]{1,4}$ ]] && [ "$repetitions" -ge 3 ] || refuse "--repetitions $repetitions, must be 3..9999"
[ -z "$renew" ] || [ -z "$filter" ] || refuse "--renew needs all benchmarks, not --filter"
[ -n "$renew" ] || [ -f "$baseline" ] || refuse "--against $baseline: no such file"
command -v python3 >/dev/null || { echo "bench.sh: needs python3" >&2; exit 1; }

scripts/setup.sh
cmake --build build --target ltcfit_bench
mkdir -p out
options=(--benchmark_repetitions="$repetitions" --benchmark_enable_random_interleaving=true
  --benchmark_min_time=0.1 --benchmark_out=out/bench_raw.json --benchmark_out_format=json)
if [ -n "$filter" ]; then
  build/tests/ltcfit_bench --benchmark_list_tests --benchmark_filter="$filter" >/dev/null 2>&1 ||
    refuse "--filter '$filter': matches no benchmark"
  options+=(--benchmark_filter="^calibration$|$filter")
fi
echo "running the benchmarks, $repetitions times each"
rm -f out/bench_raw.json
build/tests/ltcfit_bench "${options[@]}" >/dev/null 2>out/bench.log || { cat out/bench.log >&2; exit 1; }
scripts/bench_compare.py condense out/bench_raw.json out/bench.json
if [ -n "$renew" ]; then
  cp out/bench.json data/bench/baseline.json
  exec scripts/bench_compare.py show out/bench.json
fi
exec scripts/bench_compare.py compare "$baseline" out/bench.json ${filter:+--subset}
