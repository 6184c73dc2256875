# The page of `ltcfit report` in Chromium: bash report.sh PART LTCFIT SOURCE_DIR BUILD_WEB CHARTS [PICTURES]
# PART: glance (a real one stands, and has its size), pages (it and made-up ones must be good in all) or broken (what is
# wrong with broken ones must be noticed).
# CHARTS is the charting library that the build embeds. Pictures for people are left in PICTURES, where it is given.
set -u
part=$1
ltcfit=$2
source_dir=$3
build_web=$4
charts=$5
pictures=${6:-}
web=$source_dir/tests/web

. "$web/chromium.sh"
bash "$web/install.sh" "$source_dir" "$build_web" check || exit $?

if [ ! -s "$charts" ]; then
  echo "SKIPPED: built without the charting library; there is no page without it"
  exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
report=
if [ "$part" != broken ]; then
  # made-up results of `ltcfit check-gl`, `ltcfit pareto` and `ltcfit stability`: real ones take minutes
  node "$web/report_files.mjs" "$work" || { echo "FAILED: sample files"; exit 1; }
  theirs=$build_web/node_modules/three/examples/jsm/lights/RectAreaLightTexturesLib.js
  report=$work/report.html
  # few samples: the page is tested here, not the figures
  "$ltcfit" report "$source_dir/data/ltc_iso.json" "$source_dir/data/ltc_aniso.json" --against "$theirs" \
    --shading "$work/shading_iso.json" --shading "$work/shading_aniso.json" \
    --pareto "$work/pareto_iso.json" --pareto "$work/pareto_aniso.json" --stability "$work/stability.json" \
    --samples 256 --directions 8 --quads 16 --lights 16 --points 128 -o "$report" --quiet || { echo "FAILED: ltcfit report"; exit 1; }
fi
node "$web/report.mjs" "$part" "$report" "$source_dir" "$build_web" "$charts" "$chromium" "$pictures"
