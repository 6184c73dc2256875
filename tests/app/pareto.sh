# Error against time: figures that do not depend on threads, and defaults that are those of fit.
. "$(dirname "$0")/common.sh" "$@"

small="--entries 2 --repeats 2 --samples 64 --directions 2 --quads 2 --lights 8"
for table in iso aniso; do
  for threads in 1 2; do
    # shellcheck disable=SC2086
    "$ltcfit" pareto -q --table $table $small --fitter moments --fitter light --threads $threads -o $table$threads.json > $table.txt ||
      fail "pareto $table"
  done
  grep -q "^ltcfit fit $table: light, " $table.txt || fail "nothing on the default of fit $table"
done
"$ltcfit" fit iso -q -o fit_iso.json --size 2x2 || fail "fit iso"
"$ltcfit" fit aniso -q -o fit_aniso.json --size 2x2x2x2 || fail "fit aniso"
python3 - <<'PY' || fail "the figures"
import json, math

def errors(data):  # all but what is measured in seconds, and follows from it
    data = json.loads(json.dumps(data))
    for setting in data['settings']:
        del setting['cpu_seconds']
        for error in setting['errors'].values():
            del error['front']
    for default in data['defaults']:
        del default['why']
    return data

for table in ('iso', 'aniso'):
    one, two = (json.load(open(f'{table}{threads}.json')) for threads in (1, 2))
    assert errors(one) == errors(two), 'the errors depend on the threads'
    assert one['format'] == 'ltcfit-pareto' and one['version'] == 1 and one['table'] == table
    assert len(one['entries']) == 2
    names = [metric['name'] for metric in one['metrics']]
    for setting in one['settings']:
        assert list(setting['errors']) == names
        seconds = setting['cpu_seconds']
        assert 0 < seconds['low'] <= seconds['median'] <= seconds['high']
        for e in setting['errors'].values():
            assert 1 <= e['low'] <= e['ratio'] <= e['high'] and e['value'] > 0
    # the front of each metric, found another way: by time, only what improves
    for name in names:
        best, front = math.inf, set()
        order = sorted(range(len(one['settings'])), key=lambda s: (
            one['settings'][s]['cpu_seconds']['median'], one['settings'][s]['errors'][name]['ratio']))
        for s in order:
            if one['settings'][s]['errors'][name]['ratio'] < best:
                best = one['settings'][s]['errors'][name]['ratio']
                front.add(s)
        assert front == {s for s in order if one['settings'][s]['errors'][name]['front']}, name
    # the default is what fit says that it did
    (default,) = one['defaults']
    setting = one['settings'][default['setting']]
    provenance = json.load(open(f'fit_{table}.json'))['provenance']['options']
    assert setting['default_of'] == [default['command']] == [f'fit {table}']
    assert setting['fitter'] == provenance['fitter'] and setting['preset'] == provenance['preset']
PY
# the file says how to make it again
command=$(python3 -c "import json; print(json.load(open('iso1.json'))['command'])")
$ltcfit ${command#ltcfit } -q --json > again.json || fail "'$command'"
python3 - <<'PY' || fail "'$command' gives other errors"
import json
a, b = json.load(open('iso1.json')), json.load(open('again.json'))
assert [s['errors']['SW1']['value'] for s in a['settings']] == [s['errors']['SW1']['value'] for s in b['settings']]
PY
# what goes to a stream is the data alone
"$ltcfit" pareto -q --entries 1 --repeats 1 --fitter moments -o /dev/stdout | python3 -c "import json, sys; json.load(sys.stdin)" ||
  fail "notes among the data"
finish
