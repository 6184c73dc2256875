#!/usr/bin/env bash
# Before a commit: formatting, clang-tidy, and the tests under AddressSanitizer and UndefinedBehaviorSanitizer.
# Needs clang-format and clang-tidy (Debian packages of the same names).
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh
files=$(git ls-files -- '*.cpp' '*.h' | grep -v '^data/')
echo "$files" | xargs clang-format --dry-run -Werror
echo "$files" | grep '\.cpp$' | grep -v '^tests/' | xargs clang-tidy -p build --quiet
cmake --preset asan >/dev/null
cmake --build --preset asan -- --quiet
ctest --preset asan -j "$(nproc)" --output-on-failure
