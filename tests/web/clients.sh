# ltcfit's files in the engines that load them: bash clients.sh LTCFIT SOURCE_DIR BUILD_WEB [PICTURES]
# Pictures are left in PICTURES, BUILD_WEB/pictures if not given.
set -u
ltcfit=$1
source_dir=$2
build_web=$3
pictures=${4:-$build_web/pictures}
web=$source_dir/tests/web

. "$web/chromium.sh"
bash "$web/install.sh" "$source_dir" "$build_web" check || exit $?

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
theirs=$build_web/node_modules/three/examples/jsm/lights/RectAreaLightTexturesLib.js
mkdir "$work/ours"
# TABLE PROFILE FILE
export_table() {
  "$ltcfit" export "$1" --profile "$2" -o "$work/$3" || { echo "FAILED: export --profile $2 of $1"; exit 1; }
}
export_table "$source_dir/data/ltc_iso.json" three ours/three.js
export_table "$source_dir/data/ltc_iso.json" babylon ours/areaLightsLTC.bin
export_table "$source_dir/data/ltc_iso.json" playcanvas ours/area-light-luts.bin
# the table of 2017, which three alone brings along
export_table "$theirs" playcanvas theirs.bin

node "$web/clients.mjs" "$work" "$build_web" "$chromium" "$pictures"
