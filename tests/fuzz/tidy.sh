# What clang-tidy finds of bugs in the sources, in the units in which they are compiled: bash tidy.sh SOURCE_DIR BUILD
# BUILD is configured for clang, with all that is generated in it.
set -u
source_dir=$1
build=$2
command -v clang-tidy >/dev/null || { echo "SKIPPED: clang-tidy is not installed"; exit 77; }
folders='app|base|export|fit|ggx|ltc|render|report|scene|tailor'
units=$(find "$build" -path '*/Unity/unity_*_cxx.cxx')
[ "$(wc -l <<<"$units")" -gt 20 ] || { echo "FAILED: the units are elsewhere"; exit 1; }

# tidy FOLDER UNIT...: the units' own files are those of FOLDER
tidy() {
  printf '%s\0' "${@:2}" | xargs -0 -n 1 -P "$(nproc)" clang-tidy -p "$build" --quiet \
    --config-file="$source_dir/.clang-tidy" --header-filter="^$1/($folders)/" 2>/dev/null
}
# a bug is found where it is looked for
planted=$(mktemp -d)
trap 'rm -rf "$planted"' EXIT
mkdir "$planted/ltc"
echo '#include "ltc/a.cpp"' > "$planted/unit.cpp"
printf 'clang++ -std=c++20 -I%s -c unit.cpp' "$planted" |
  sed "s|.*|[{\"directory\": \"$planted\", \"file\": \"unit.cpp\", \"command\": \"&\"}]|" > "$planted/compile_commands.json"
find_in() { (build=$planted; cd "$planted" && tidy "$planted" unit.cpp) > "$planted/found.txt"; }
echo 'int half(int a) { return a / 2; }' > "$planted/ltc/a.cpp"
find_in || { echo "FAILED: takes offence at a good file: $(cat "$planted/found.txt")"; exit 1; }
echo 'double half(int a) { double b = a / 2; return b; }' > "$planted/ltc/a.cpp"
find_in && { echo "FAILED: does not see a planted bug: $(cat "$planted/found.txt")"; exit 1; }

# shellcheck disable=SC2086
tidy "$source_dir" $units || { echo "FAILED: clang-tidy's findings"; exit 1; }
echo "all passed"
