# Installs the pinned packages into BUILD_WEB/node_modules, outside the source tree: bash install.sh SOURCE_DIR BUILD_WEB
# Nothing is done while package-lock.json is the one installed. Packages' own install scripts do not run.
set -eu
source_dir=$1
build_web=$2
for program in node npm; do
  if ! command -v "$program" > /dev/null; then
    echo "SKIPPED: $program is not installed; the tests in real web engines need it"
    exit 77
  fi
done
mkdir -p "$build_web"
exec 9> "$build_web/install.lock"
flock 9
lock=$source_dir/tests/web/package-lock.json
stamp=$build_web/installed-package-lock.json
if cmp -s "$lock" "$stamp"; then
  echo "up to date"
  exit 0
fi
rm -f "$stamp"
cp "$source_dir/tests/web/package.json" "$lock" "$build_web/"
(cd "$build_web" && npm ci --ignore-scripts --no-audit --no-fund)
cp "$lock" "$stamp"
