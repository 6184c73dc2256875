# ltcfit report: page and JSON, and what it refuses.
. "$(dirname "$0")/common.sh" "$@"

"$ltcfit" fit iso -q -o iso.json --size 6x6 --lights 32 --alpha-floor 0.01 && "$ltcfit" fit aniso -q -o aniso.json --size 3x3x3x3 --lights 32 || fail "fits"
small="-q --samples 128 --directions 4 --quads 4 --lights 4 --points 8"
cp iso.json second.json
"$ltcfit" report iso.json $small -o first.html 2>stderr.txt
if [ $? -eq 1 ] && grep -q "no charting library.*LTCFIT_ECHARTS" stderr.txt; then
  [ -e first.html ] && fail "a page without charts"
  [ "$failures" -eq 0 ] && echo "SKIPPED: this build has no charting library" && exit 77
  finish
fi
# what the page is made of
"$ltcfit" report iso.json aniso.json --against second.json $small --threads 1 -o one.html || fail "report of two tables"
"$ltcfit" report iso.json aniso.json --against second.json $small --threads 2 -o two.html || fail "report with 2 threads"
cmp -s one.html two.html && cmp -s one.json two.json || fail "the report depends on the threads"
python3 - <<'PY' || fail "the page or its JSON"
import json, re
text = open('one.json', encoding='utf-8').read().rstrip('\n')
page = open('one.html', encoding='utf-8').read()
r = json.loads(text)
assert r['format'] == 'ltcfit-report' and [t['kind'] for t in r['tables']] == ['isotropic', 'anisotropic'], r['format']
assert r['tables'][0]['against'] == ['second.json'] and r['tables'][1]['against'] == []
inside = re.search(r'<script type="application/json" id="report">(.*?)</script>', page, re.S).group(1)
assert inside == text.replace('<', '\\u003c'), 'the page holds other JSON than the file'
images = json.loads(re.search(r'<script type="application/json" id="images">(.*?)</script>', page, re.S).group(1))
named = [i['id'] for t in r['tables'] for lobe in t['lobes'] for i in lobe['images']]
assert sorted(named) == sorted(images) and len(named) > 20, 'pictures'
assert '<title>iso.json, aniso.json</title>' in page and 'LTCFIT-' not in page
for tag in re.findall(r'<(?:script|link|img|iframe)[^>]*>', page.split('id="report"')[0]):
    assert 'src=' not in tag and 'http' not in tag, tag
# the second table is the same as the first: every ratio is 1, every map the same
ratios = [v for v in r['tables'][0]['verdicts'] if 'over that of' in v['what']]
assert len(ratios) == 7 and all(v['value'] == 1 and v['pass'] for v in ratios)
maps = {(m['metric'], m['table']): m['values'] for m in r['tables'][0]['maps']}
assert maps['TV', 'iso.json'] == maps['TV', 'second.json'] and len(maps['TV', 'iso.json']) == 36
PY
# the figures are those of `ltcfit score`
"$ltcfit" score iso.json -q --json --stored-as Minv --points off-grid --count 8 --samples 128 --directions 4 --quads 4 --lights 4 > score.json
python3 - <<'PY' || fail "other figures than score"
import json
score = json.load(open('score.json'))['tables'][0]['metrics']
report = json.load(open('one.json'))['tables'][0]['scores']
metrics = next(s for s in report if s['points'] == 'off-grid')['results'][0]['metrics']
for name in metrics:
    for key in metrics[name]:
        assert metrics[name][key] == float('%.5g' % score[name][key]), (name, key)
PY
# names are text
cp iso.json '<b>&x.json'; "$ltcfit" report '<b>&x.json' $small -o name.html || fail "a strange name"
grep -q '<title>&lt;b&gt;&amp;x.json</title>' name.html || fail "the name is not escaped"
grep -q '"name":"\\u003cb>&x.json"' name.html || fail "the name in the page's JSON"
rm '<b>&x.json' name.html name.json

# pareto and stability files
python3 - <<'PY'
import json
entry = {'alpha_x': 0.1, 'alpha_y': 0.1, 'theta_degrees': 30, 'phi_degrees': 0}
pareto = {'format': 'ltcfit-pareto', 'version': 1, 'table': 'iso', 'command': 'c', 'tool_version': '0', 'options': {},
  'entries': [entry], 'metrics': [{'name': 'SW1', 'unit': '', 'meaning': 'm'}],
  'settings': [{'fitter': 'sw', 'name': '</script>', 'effort': {}, 'preset': '', 'default_of': [], 'entries': 1, 'runs': 1,
    'cpu_seconds': {'median': 1, 'low': 1, 'high': 1},
    'errors': {'SW1': {'ratio': 1, 'low': 1, 'high': 1, 'value': 1, 'front': True}}, 'not_converged': 0, 'non_finite': 0}],
  'defaults': []}
stability = {'format': 'ltcfit-stability', 'version': 1, 'command': 'c', 'tool_version': '0', 'set': 's', 'limits': [],
  'starts': [], 'seeds': [], 'summary': [], 'rows': [], 'findings': []}
import base64, struct, zlib
def chunk(name, data):
    return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))
png = base64.b64encode(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2, 1, 8, 0, 0, 0, 0)) +
    chunk(b'IDAT', zlib.compress(b'\0\x40\x80')) + chunk(b'IEND', b'')).decode()
shading = {'format': 'ltcfit-shading', 'version': 1, 'command': 'c', 'tool_version': '0',
  'table': {'name': '</script>', 'source': 's', 'isotropic': True, 'precision': 'half'}, 'against': None, 'renderer': 'r', 'options': {},
  'passed': False, 'scenes': [{'name': 'a', 'title': '</script>', 'random': False, 'loss': '', 'alpha': [1, 1],
    'gl': {'psnr': 40, 'floor': 50, 'largest': 1, 'non_finite': 0, 'kinds_differ': 0, 'pixels': 1}, 'passed': False,
    'reference': {'rmse': 1e-5, 'samples': 1, 'resolved': True}, 'error': {'rmse': 0.01, 'relative_mse': 0, 'psnr': 40, 'largest': 1},
    'against': None, 'clipping': None, 'explanation': '', 'pictures': {'ltc': png, 'reference': png, 'difference': png}}],
  'random': None, 'cost': [], 'frames': []}
json.dump(shading, open('shading.json', 'w'))
json.dump({**shading, 'table': {**shading['table'], 'isotropic': False}}, open('brushed.json', 'w'))
json.dump(pareto, open('pareto.json', 'w'))
json.dump(stability, open('stability.json', 'w'))
text = open('pareto.json').read()
open('cut.json', 'w').write(text[:len(text) // 2])
open('big.json', 'w').write(text + ' ' * (17 << 20))
def bad(name, source, change):
    t = json.loads(json.dumps(source))
    change(t)
    json.dump(t, open(name, 'w'))
bad('front.json', pareto, lambda t: t['settings'][0]['errors']['SW1'].pop('front'))
bad('defaults.json', pareto, lambda t: t['defaults'].append({'command': 'x', 'setting': 3, 'why': ''}))
def forever(t):
    t['settings'][0]['cpu_seconds'].update(median=1e300, high=1e300)
bad('forever.json', pareto, forever)
bad('passed.json', shading, lambda t: t['scenes'][0].update(passed=True))
bad('picture.json', shading, lambda t: t['scenes'][0]['pictures'].update(ltc='</script>'))
bad('rows.json', stability, lambda t: t['rows'].append(entry))
PY
"$ltcfit" report iso.json $small --shading shading.json --shading brushed.json --pareto pareto.json --stability stability.json -o full.html || fail "shading, pareto and stability"
python3 -c "
import json; r = json.load(open('full.json'))
assert r['shading'] == [json.load(open(f)) for f in ('shading.json', 'brushed.json')]
assert '--shading shading.json --shading brushed.json' in r['command']
assert r['pareto'] == [json.load(open('pareto.json'))] and r['stability'] == json.load(open('stability.json'))" || fail "files are changed on their way"
[ "$(grep -o '</script>' full.html | wc -l)" = "$(grep -o '</script>' one.html | wc -l)" ] || fail "a name ends the script"

# and those that the commands write
echo '{"format": "ltcfit-stability-set", "version": 1, "name": "two", "alpha": [0.1], "lambda": [1, 0.1], "theta_degrees": [60], "phi_degrees": [17], "alpha_floor": 0.00001}' > set.json
"$ltcfit" stability -q --set set.json --fitter light --seeds 1 -o real_stability.json > out.txt || fail "stability"
for table in iso aniso; do
  "$ltcfit" pareto -q --table $table --entries 2 --repeats 1 --fitter moments --samples 64 --directions 2 --quads 2 --lights 8 -o real_$table.json > out.txt || fail "pareto $table"
done
"$ltcfit" report iso.json $small --pareto real_iso.json --pareto real_aniso.json --stability real_stability.json -o full.html || fail "real pareto and stability"
rm out.txt

expect() { # MESSAGE OPTIONS...
  local message=$1
  shift
  "$ltcfit" report $small "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -q -- "$message" stderr.txt || fail "no '$message' in the message of: $* -- $(cat stderr.txt)"
  [ "$(grep -c . stderr.txt)" -le 3 ] || fail "long message: $*"
}
sha256sum *.json > before.txt; ls > listing.txt
expect "second.json: a second isotropic table; --against" iso.json second.json -o x.html
expect "aniso.json: an anisotropic table, and no table of that kind" iso.json --against aniso.json -o x.html
expect "missing.json" missing.json -o x.html
expect "missing.json" iso.json --pareto missing.json -o x.html
expect "cut.json: not valid JSON" iso.json --pareto cut.json -o x.html
expect "big.json" iso.json --pareto big.json -o x.html
expect "front.json: settings.0..errors.SW1.front is missing" iso.json --pareto front.json -o x.html
expect "defaults.json: defaults.0..setting is not one of the 1 settings" iso.json --pareto defaults.json -o x.html
expect "forever.json: settings.0..cpu_seconds.median is 1e+300, not a time within 1e-09..1e+06 s" iso.json --pareto forever.json -o x.html
expect "pareto.json: table: a second file about 'iso'" iso.json --pareto pareto.json --pareto pareto.json -o x.html
expect "stability.json: not what is asked for: format is not \"ltcfit-pareto\"" iso.json --pareto stability.json -o x.html
expect "passed.json: scenes.0..passed is true, with a PSNR of 40 dB, a floor of 50 dB" iso.json --shading passed.json -o x.html
expect "picture.json: scenes.0..pictures.ltc is not base64" iso.json --shading picture.json -o x.html
expect "shading.json: table: a second file about an isotropic table" iso.json --shading shading.json --shading shading.json -o x.html
expect "shading.json: would overwrite this input" iso.json --shading shading.json -o shading.html
expect "rows.json: rows.0..fitter is missing" iso.json --stability rows.json -o x.html
expect "iso.json: would overwrite this input" iso.json -o iso.html
expect "second.json: would overwrite this input" iso.json --against second.json -o ./second.html
expect "pareto.json: would overwrite this input" iso.json --pareto pareto.json -o pareto.html
expect "needs another name" iso.json -o x.json
expect "no/such" iso.json -o no/such/x.html
expect "not a file" iso.json -o /dev/stdout
expect "--points" iso.json -o x.html --points 0
expect "TABLE" -o x.html
rm -f stdout.txt stderr.txt
sha256sum --quiet -c before.txt || fail "an input was changed"
rm -f before.txt
[ "$(ls)" = "$(grep -v -e before.txt -e stderr.txt listing.txt)" ] || fail "files were left: $(ls | diff listing.txt - | tr '\n' ' ')"

# a page that cannot be written leaves the old pair: room for the JSON, not for the page
"$ltcfit" report iso.json $small -o pair.html || fail "the pair"
sha256sum pair.html pair.json > pair.txt
[ "$(stat -c %s pair.json)" -lt 204800 ] && [ "$(stat -c %s pair.html)" -gt 409600 ] || fail "the limit is not between the two"
(trap '' XFSZ; ulimit -f 300; exec "$ltcfit" report iso.json $small --seed 2 -o pair.html 2> err.txt)
[ $? -eq 1 ] && grep -q "pair.html: cannot write: File too large" err.txt || fail "a page of more than the limit: $(cat err.txt)"
sha256sum --quiet -c pair.txt || fail "half of the pair was replaced"

# limits that are not kept: shown, and exit 3 only if asked for
python3 - <<'PY'
import json
t = json.load(open('iso.json'))
t['data'][7 * 9 + 5] += 0.1
json.dump(t, open('spoilt.json', 'w'))
PY
"$ltcfit" report spoilt.json $small -o s.html || fail "exit $? without --gate"
"$ltcfit" report spoilt.json $small --gate -o s.html > out.txt 2> err.txt
[ $? -eq 3 ] && [ -s s.html ] || fail "no exit 3 with --gate, or no page"
[ -s out.txt ] && fail "quiet, and yet: $(cat out.txt)"
grep -q "not kept: Norm, largest error at nodes: 0.1" err.txt || fail "quiet, and no limit named: $(cat err.txt)"
"$ltcfit" report spoilt.json $small -o s.html 2> err.txt && [ ! -s err.txt ] || fail "no gate asked for: $(cat err.txt)"
"$ltcfit" report iso.json --against spoilt.json --samples 128 --directions 4 --points 8 --gate -o g.html > summary.txt || fail "a good table does not pass the gate"
grep -q "iso.json: 16 of 16 limits are kept" summary.txt || fail "summary: $(cat summary.txt)"
finish
