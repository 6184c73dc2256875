# The page of `ltcfit report` in Chromium: bash report.sh LTCFIT SOURCE_DIR BUILD_WEB [PICTURES]
# Pictures are left in PICTURES, BUILD_WEB/pictures if not given.
set -u
ltcfit=$1
source_dir=$2
build_web=$3
pictures=${4:-$build_web/pictures}
web=$source_dir/tests/web

chromium=
for name in chromium chromium-browser google-chrome; do
  if [ -z "$chromium" ]; then chromium=$(command -v "$name" || true); fi
done
if [ -z "$chromium" ]; then
  echo "SKIPPED: chromium is not installed; the test of the report's page needs it"
  exit 77
fi
bash "$web/install.sh" "$source_dir" "$build_web" || exit $?

# the charting library of the page, as pinned
page=$build_web/page
if ! cmp -s "$source_dir/report/page/package-lock.json" "$page/installed-package-lock.json"; then
  mkdir -p "$page"
  cp "$source_dir/report/page/package.json" "$source_dir/report/page/package-lock.json" "$page/"
  (cd "$page" && npm ci --ignore-scripts --no-audit --no-fund) || { echo "FAILED: npm ci"; exit 1; }
  cp "$source_dir/report/page/package-lock.json" "$page/installed-package-lock.json"
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# made-up results of `ltcfit pareto` and `ltcfit stability`: real ones take hours
node "$web/report_files.mjs" "$work" || { echo "FAILED: sample files"; exit 1; }
theirs=$build_web/node_modules/three/examples/jsm/lights/RectAreaLightTexturesLib.js
report=
if "$ltcfit" report --help > /dev/null 2>&1; then
  report=$work/report.html
  # few samples: the page is tested here, not the figures
  "$ltcfit" report "$source_dir/data/ltc_iso.json" "$source_dir/data/ltc_aniso.json" --against "$theirs" \
    --pareto "$work/pareto_iso.json" --pareto "$work/pareto_aniso.json" --stability "$work/stability.json" \
    --samples 256 --directions 8 --quads 16 --lights 16 --points 128 -o "$report" --quiet || { echo "FAILED: ltcfit report"; exit 1; }
else
  echo "this ltcfit has no command report: made-up reports only"
fi
node "$web/report.mjs" "$report" "$source_dir" "$build_web" "$chromium" "$pictures"
