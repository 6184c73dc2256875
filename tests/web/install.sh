# Installs the pinned packages into BUILD_WEB/node_modules, outside the source tree: bash install.sh SOURCE_DIR BUILD_WEB [check]
# Nothing is done while package-lock.json is the one installed. Packages' own install scripts do not run. With `check`
# nothing is installed: the test that needs the packages is skipped where they are not there. A registry that is out of
# reach skips as well; packages that are not the pinned ones fail.
set -eu
source_dir=$1
build_web=$2
for program in node npm; do
  if ! command -v "$program" > /dev/null; then
    echo "SKIPPED: $program is not installed; the tests in real web engines need it"
    exit 77
  fi
done
if [ "${3:-}" = check ] && ! cmp -s "$source_dir/tests/web/package-lock.json" "$build_web/installed-package-lock.json"; then
  echo "SKIPPED: the npm packages are not in $build_web; the test web.packages installs them, or says why not"
  exit 77
fi
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
unreachable='npm (ERR!|error) code (E(CONN|NOTFOUND|AI_AGAIN|TIMEDOUT|HOST|NET|PROTO|PIPE)|ERR_|FETCH_|[A-Z_]*CERT|E(403|407|5[0-9][0-9]))'
(cd "$build_web" && npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-timeout=60000 --fetch-retries=1 \
  --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=2000) 2> "$build_web/npm.log" || {
  cat "$build_web/npm.log"
  grep -qE "$unreachable" "$build_web/npm.log" || exit 1
  echo "SKIPPED: npm cannot reach its registry; the tests in real web engines need packages from it"
  exit 77
}
cp "$lock" "$stamp"
