# The 3-parameter fit at the very nodes of the table of 2017 against that table: its own objective, on a larger set of samples that neither has seen.
. "$(dirname "$0")/common.sh" "$@"
if [ ! -e "$reference_dir/ltc2017-1.npy" ]; then
  echo "SKIPPED: the published tables are not at $reference_dir"
  exit 77
fi
"$ltcfit" fit iso -q --fitter l3 -o f3.json --family 3 --alpha-floor 1e-5 --theta-max 1.57 || fail "the fit"
"$ltcfit" score -q f3.json --against "$reference_dir/ltc2017-1.npy" --count 0 --samples 8192 --directions 1 --quads 1 \
  --lights 1 --seed 12 --json > score.json || fail "the score"
python3 - <<'PY' || fail "a figure"
import json, sys
ours, theirs = (t['metrics'] for t in json.load(open('score.json'))['tables'])
singular = json.load(open('score.json'))['tables'][0]['singular_float32']
ok = True
for name in ('L3', 'L3cost'):
    for figure in ('mean', 'p50', 'p90'):
        a, b = ours[name][figure], theirs[name][figure]
        print(f'{name} {figure}: {a:.6g} against {b:.6g}, ratio {a / b:.4f}')
        ok = ok and a <= b
print('albedo error, max:', ours['albedo_error']['max'], 'against', theirs['albedo_error']['max'])
print('singular in float32:', singular)
ok = ok and ours['albedo_error']['max'] <= 1e-3 and singular == 0
sys.exit(0 if ok else 1)
PY
for f in ltc2017-1.dds kt2022-alpha-lambda-theta-phi.npy; do
  "$ltcfit" score -q "$reference_dir/$f" --count 20 > /dev/null || fail "cannot score $f"
done
finish
