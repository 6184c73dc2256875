# Shared by the tests of the program: bash SCRIPT LTCFIT SOURCE_DIR REFERENCE_DIR
set -u
if grep -q python3 "$0" && ! command -v python3 >/dev/null; then
  echo "SKIPPED: python3 is not installed; it does the arithmetic of this test"
  exit 77
fi
ltcfit=$1
source_dir=$2
reference_dir=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
finish() { if [ "$failures" -gt 0 ]; then echo "$failures failed"; exit 1; fi; echo "all passed"; exit 0; }
