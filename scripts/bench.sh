#!/usr/bin/env bash
# Benchmarks with the error reached next to the time: medians of 5 and their spread. Arguments go to the program,
# for example --benchmark_filter=fitEntry.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
exec build/tests/ltcfit_bench --benchmark_repetitions=5 --benchmark_report_aggregates_only=true "$@"
