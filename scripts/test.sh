#!/usr/bin/env bash
# Sets up, builds and runs all tests. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --tests
exec ctest --test-dir build --output-on-failure -j "$(nproc)" "$@"
