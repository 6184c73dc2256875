# Stability: figures that do not depend on threads, exit 3 where a limit is broken, bad sets refused.
. "$(dirname "$0")/common.sh" "$@"

head='"format":"ltcfit-stability-set","version":1,"name":"few"'
echo "{$head,\"alpha\":[0.1],\"lambda\":[1,0.2],\"theta_degrees\":[60],\"phi_degrees\":[30]}" > few.json
for threads in 1 2; do
  "$ltcfit" stability -q --set few.json --seeds 2 --threads $threads -o few$threads.json > few$threads.txt || fail "few: exit $?"
done
cmp few1.json few2.json || fail "the figures depend on threads"
cmp <("$ltcfit" stability -q --set few.json --seeds 2 --json) few1.json || fail "--json differs from -o"
grep -q '^0 of the rows of light break a limit' few1.txt || fail "nothing on the limits"
python3 - <<'PY' || fail "the figures"
import json
data = json.load(open('few1.json'))
assert data['format'] == 'ltcfit-stability' and data['lobes'] == 2
assert data['command'] == 'ltcfit stability --set few.json --seeds 2', data['command']
limits = {limit['id']: limit['limit'] for limit in data['limits']}
for row in data['rows']:
    results = row['results']
    assert len(results) == row['runs'] == (8 if row['default'] else 4)
    assert sum(row['outcomes'].values()) == row['runs']
    assert (row['pass'] is None) == (not row['default'])
    # the spreads, from the single runs
    def spread(values):
        return max(values) / min(values) - 1
    seeds = {seed for _, seed, _, _ in results}
    starts = max(spread([s for _, seed, _, s in results if seed == one]) for one in seeds)
    assert abs(starts - row['spread_starts']) <= 1e-3 * starts + 1e-3, (starts, row['spread_starts'])
    usual = [s for start, _, _, s in results if start == 'moments']
    assert abs(spread(usual) - row['spread_seeds']) <= 1e-3 * spread(usual) + 1e-3
    assert row['sw1'] == usual[0]
    if row['default']:
        assert row['spread_starts'] <= limits['spread_starts'] and row['broken'] == []
PY
# a needle sharper than the tables' floor, where the default fitter is far above the best
echo "{$head,\"alpha\":[2e-5],\"lambda\":[0.5],\"theta_degrees\":[89.5],\"phi_degrees\":[5]}" > needle.json
"$ltcfit" stability -q --set needle.json --fitter light --fitter sw > needle.txt
[ $? -eq 3 ] || fail "a broken limit is not exit 3"
grep -q 'sw1_over_best' needle.txt || fail "the broken limit is not named"

# expect MESSAGE OPTIONS...: refused with exit 2 and the message
expect() {
  local message=$1
  shift
  "$ltcfit" stability -q "$@" > out.txt 2> err.txt
  [ $? -eq 2 ] || fail "exit $?, not 2: $*"
  grep -q -- "$message" err.txt || fail "no '$message': $(cat err.txt)"
}
echo "{$head,\"alpha\":[7],\"lambda\":[1],\"theta_degrees\":[0],\"phi_degrees\":[0]}" > large.json
echo '{"format":"ltc-table"}' > table.json
echo '{' > cut.json
expect "large.json: stability set: alpha: 7 is not in" --set large.json
expect 'format must be "ltcfit-stability-set"' --set table.json
expect "cut.json: stability set: not a JSON object" --set cut.json
expect "missing.json" --set missing.json
expect "would overwrite the set" --set few.json -o ./few.json
expect "--fitter" --fitter newton
expect "--seeds" --seeds 0
expect "--threads" --threads -1
finish
