# The tables in data/ are what the program makes today: the same bytes here; on a processor whose mathematical library
# rounds otherwise, the same numbers to what the optimizer's tolerance leaves open.
. "$(dirname "$0")/common.sh" "$@"
for kind in iso aniso; do
  "$ltcfit" fit $kind -q -o ltc_$kind.json || fail "the fit of $kind"
  if ! cmp -s ltc_$kind.json "$source_dir/data/ltc_$kind.json"; then
    echo "ltc_$kind.json: not the same bytes"
    python3 - ltc_$kind.json "$source_dir/data/ltc_$kind.json" <<'PY' || fail "data/ltc_$kind.json"
import json, sys
a, b = (json.load(open(f)) for f in sys.argv[1:])
same = all(a[k] == b[k] for k in a if k != 'data') and len(a['data']) == len(b['data'])
worst = max(abs(x - y) for x, y in zip(a['data'], b['data']))
print('largest difference', worst)
sys.exit(0 if same and worst < 1e-3 else 1)
PY
  fi
  "$ltcfit" export -q "$source_dir/data/ltc_$kind.json" -o ltc_$kind.ktx2 --precision half &&
    cmp ltc_$kind.ktx2 "$source_dir/data/ltc_$kind.ktx2" || fail "data/ltc_$kind.ktx2"
  "$ltcfit" export -q "$source_dir/data/ltc_$kind.json" --format h -o ltc_$kind.h && cmp ltc_$kind.h "$source_dir/data/ltc_$kind.h" || fail "data/ltc_$kind.h"
done
"$ltcfit" export -q "$source_dir/data/ltc_iso.json" --format chebyshev -o ltc_iso || fail "the polynomials"
for extension in json glsl hlsl h js; do
  cmp ltc_iso.cheb.$extension "$source_dir/data/ltc_iso.cheb.$extension" || fail "data/ltc_iso.cheb.$extension"
done
(cd "$source_dir/data" && sha256sum --quiet -c SHA256SUMS) || fail "data/SHA256SUMS"
finish
