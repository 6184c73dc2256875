# data/scenes holds what its script writes: bash fixtures.sh PYTHON SOURCES FOLDER
set -eu
rm -rf "$3"
"$1" "$2/scripts/make_scenes.py" "$3"
for file in "$3"/*; do cmp "$file" "$2/data/scenes/$(basename "$file")"; done
