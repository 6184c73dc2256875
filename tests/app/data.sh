# The tables in data/ are what the program makes today: the same bytes here; on a processor whose mathematical library
# rounds otherwise, the same numbers to what the optimizer's tolerance leaves open.
. "$(dirname "$0")/common.sh" "$@"
"$ltcfit" fit iso -q -o ltc_iso.json || fail "the fit"
if ! cmp -s ltc_iso.json "$source_dir/data/ltc_iso.json"; then
  echo "not the same bytes"
  python3 - "$source_dir/data/ltc_iso.json" <<'PY' || fail "data/ltc_iso.json"
import json, sys
a, b = json.load(open('ltc_iso.json')), json.load(open(sys.argv[1]))
same = all(a[k] == b[k] for k in a if k != 'data') and len(a['data']) == len(b['data'])
worst = max(abs(x - y) for x, y in zip(a['data'], b['data']))
print('largest difference', worst)
sys.exit(0 if same and worst < 1e-3 else 1)
PY
fi
"$ltcfit" export -q "$source_dir/data/ltc_iso.json" --format h -o ltc_iso.h && cmp ltc_iso.h "$source_dir/data/ltc_iso.h" || fail "data/ltc_iso.h"
finish
