# Every C++ file is laid out as .clang-format says: bash format.sh SOURCE_DIR
set -u
cd "$1" || exit 1
command -v clang-format >/dev/null || { echo "SKIPPED: clang-format is not installed"; exit 77; }
files=$(find app base export fit ggx ltc render report scene tailor tests \( -name '*.cpp' -o -name '*.h' \))
[ "$(wc -l <<<"$files")" -gt 300 ] || { echo "FAILED: the sources are elsewhere"; exit 1; }
# shellcheck disable=SC2086
clang-format --dry-run -Werror $files || { echo "FAILED: clang-format -i mends these"; exit 1; }
bad=$(mktemp --suffix=.cpp)
trap 'rm -f "$bad"' EXIT
echo 'int  a ;' > "$bad"
if clang-format --dry-run -Werror --style=file:"$PWD/.clang-format" "$bad" 2>/dev/null; then echo "FAILED: takes anything"; exit 1; fi
echo "all passed"
