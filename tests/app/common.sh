# Shared by the tests of the program: bash SCRIPT LTCFIT SOURCE_DIR REFERENCE_DIR
set -u
ltcfit=$1
source_dir=$2
reference_dir=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
finish() { if [ "$failures" -gt 0 ]; then echo "$failures failed"; exit 1; fi; echo "all passed"; exit 0; }
