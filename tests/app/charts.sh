# Configuration without npm or without its registry: says so, goes on, and tries again the next time.
. "$(dirname "$0")/common.sh" "$@"
export npm_config_cache=$work/cache
fetch() { cmake -DNPM="$1" -DPAGE="$source_dir/report/page" -DFOLDER="$work/charts" -P "$source_dir/report/fetch_charts.cmake" > message.txt 2>&1; }
left_out() { # REASON
  fetch "$1" || fail "$2: ends with $?: $(cat message.txt)"
  grep -q "^no charting library ($2.*built without \`ltcfit report\`; everything else is made" message.txt || fail "$2: says $(cat message.txt)"
  grep -q "$2" charts/missing.txt || fail "$2: not in missing.txt"
  [ -e charts/charts.js ] && [ ! -s charts/charts.js ] || fail "$2: charts.js is not empty"
}
npm_that() { printf '#!/bin/sh\necho called >> %s/calls\n%s\n' "$work" "$1" > npm; chmod +x npm; }
no_registry='echo "npm ERR! code ECONNREFUSED
npm ERR! network request to https://x/ failed, reason: connect ECONNREFUSED" >&2; exit 1'
install='mkdir -p node_modules/echarts/dist; echo "var echarts;" > node_modules/echarts/dist/echarts.min.js'

left_out NPM-NOTFOUND "npm is not installed"
npm_that "$no_registry"
left_out "$work/npm" "npm could not fetch it: network request to https://x/ failed, reason: connect ECONNREFUSED"
npm_that "exit 7"
left_out "$work/npm" "npm could not fetch it: 7"
npm_that "exit 0"
left_out "$work/npm" "npm could not fetch it: 0"
# within reach again: tried again, once
npm_that "$install"
rm calls
for _ in 1 2; do fetch "$work/npm" || fail "a fetch that works: $(cat message.txt)"; done
[ "$(cat charts/charts.js)" = "var echarts;" ] || fail "charts.js: $(cat charts/charts.js)"
[ ! -e charts/missing.txt ] || fail "missing.txt stays: $(cat charts/missing.txt)"
[ "$(wc -l < calls)" -eq 1 ] || fail "npm was called $(wc -l < calls) times"
# npm itself, on a port that nothing listens on
if command -v npm > /dev/null; then
  rm -r charts
  npm_config_registry=http://127.0.0.1:9 left_out "$(command -v npm)" "npm could not fetch it: .*ECONNREFUSED"
fi
finish
