#!/usr/bin/env bash
# Sets up, builds and runs the tests: all but those labelled 'long', or with --all every one. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --tests
which=(-LE long)
if [ "${1:-}" = --all ]; then
  which=()
  shift
fi
# one more than there are processors: some wait for a browser
exec ctest --test-dir build --output-on-failure -j "$(($(nproc) + 1))" "${which[@]}" "$@"
