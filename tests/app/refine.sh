# ltcfit refine and fit --refine: better between nodes, the same bytes by either way, killed runs, refused input.
. "$(dirname "$0")/common.sh" "$@"

small="--points 300 --iterations 3"
"$ltcfit" fit aniso -q -o t.json --size 3x3x3x3 --preset fast --seed 4 || fail "the fit"
cp t.json before.json
"$ltcfit" refine t.json -o r.json $small --fresh 200 --json --threads 1 > r.txt || fail "refine"
[ ! -e r.json.part ] || fail "a finished run left its checkpoint"
python3 - <<'PY' || fail "what refine says"
import json
r = json.load(open('r.txt'))['refinement']
fresh = r['fresh']
assert fresh['count'] == 200 and r['unusable'] == 0 and 1 <= r['iterations'] <= 3
assert r['cost']['end'] < r['cost']['start']
# at look-ups that it has not seen; 3x3x3x3 leaves far more than a tenth to win
for name in ('sw', 'sw_rel', 'form'):
    assert 0 < fresh['direct_fits'][name] < fresh['after'][name] < 0.9 * fresh['before'][name], (name, fresh)
assert set(r['smoothness']) == {'alpha', 'lambda', 'theta', 'phi'}
for axis in r['smoothness'].values():
    assert axis['before']['max'] > 0 and axis['after']['max'] > 0 and axis['after']['non_finite'] == 0
t, r = json.load(open('t.json')), json.load(open('r.json'))
assert r['matrix'] == {'stores': 'M', 'normalization': 'none'} and r['axes'] == t['axes']
k = t['channels'].index('norm')
n = len(t['channels'])
assert r['data'][k::n] == t['data'][k::n] and r['data'] != t['data']
assert r['provenance']['options']['fitter'] == t['provenance']['options']['fitter']
PY
"$ltcfit" score -q r.json --points off-grid --count 5 --interpolation > /dev/null || fail "score of a refined table"
"$ltcfit" export -q r.json -o r.dds --precision half || fail "export of a refined table"

# threads, and the fit in one go with the refinement
"$ltcfit" refine -q t.json -o r2.json $small --threads 2 && cmp -s r.json r2.json || fail "2 threads give another table"
"$ltcfit" fit aniso -q -o f.json --size 3x3x3x3 --preset fast --seed 4 --refine --refine-points 300 --refine-iterations 3 || fail "fit --refine"
cmp -s r.json f.json || fail "fit --refine is not fit and refine"
ls f.json.* 2>/dev/null && fail "fit --refine left a checkpoint"
command=$(python3 -c "import json; print(json.load(open('r.json'))['provenance']['command'])")
$ltcfit ${command#ltcfit } -q -o made.json && cmp -s r.json made.json || fail "'$command' makes another table"
cp t.json same.json
"$ltcfit" refine -q same.json -o same.json $small && cmp -s r.json same.json || fail "in place"

# what no fit gives: its own command, run on the table it names
"$ltcfit" refine -q r.json -o again.json --points 100 --iterations 1 --seed 9 --keep-scale || fail "refine again"
command=$(python3 -c "
import json
p = json.load(open('again.json'))['provenance']
assert p['options']['source'].startswith('ltcfit: ltcfit fit aniso') and p['options']['refine_points'] == 100
assert json.load(open('again.json'))['matrix']['normalization'] == 'third-column-unit'
print(p['command'])")
$ltcfit ${command#ltcfit } -q -o made.json && cmp -s again.json made.json || fail "'$command' makes another table"

# isotropic: what textures hold; and the same by the l3 fit
"$ltcfit" fit iso -q -o i.json --size 5x5 --lights 64 || fail "fit iso"
"$ltcfit" refine -q i.json -o ri.json --points 200 --iterations 2 || fail "refine iso"
"$ltcfit" refine -q i.json -o rm.json --points 200 --iterations 2 --stored-as M || fail "refine iso as M"
python3 - <<'PY' || fail "what isotropic tables store"
import json
r, m = json.load(open('ri.json')), json.load(open('rm.json'))
assert r['matrix'] == {'stores': 'Minv', 'normalization': 'middle-element'}
assert m['matrix'] == {'stores': 'M', 'normalization': 'third-column-unit'}
assert '--stored-as M' in m['provenance']['command'] and ' --refine' in r['provenance']['command']
PY
"$ltcfit" export -q i.json -o i.dds || fail "export"
"$ltcfit" refine -q i.dds -o ri2.json --points 200 --iterations 2 || fail "refine a DDS"
python3 -c "import json; assert json.load(open('ri2.json'))['provenance']['command'].startswith('ltcfit refine i.dds ')" || fail "a DDS is not what the fit wrote"
"$ltcfit" fit iso -q -o l.json --size 4x4 --fitter l3 --refine --refine-points 50 --refine-iterations 1 || fail "fit l3 --refine"

# killed after an iteration: nothing is written, --resume goes on, without it nothing is overwritten
long="--points 800 --iterations 15 --fresh 50"
(exec "$ltcfit" refine -q t.json -o k.json $long) & pid=$!
while kill -0 $pid 2>/dev/null && ! sed -n 2p k.json.part 2>/dev/null | grep -q '^[2-9] '; do sleep 0.02; done
kill -9 $pid 2>/dev/null || fail "the run was over before it could be killed"
wait $pid 2>/dev/null
[ ! -e k.json ] && [ -e k.json.part ] || fail "after a kill"
"$ltcfit" refine -q t.json -o k.json $long 2>message.txt
[ $? -eq 2 ] && grep -q -- "--resume goes on" message.txt || fail "an interrupted run was overwritten"
"$ltcfit" refine -q t.json -o k.json $long --seed 8 --resume 2>message.txt
[ $? -eq 2 ] && grep -q "holds another run" message.txt || fail "another run's checkpoint was taken"
cp k.json.part kept; head -c -9 kept > k.json.part
"$ltcfit" refine -q t.json -o k.json $long --resume 2>message.txt
[ $? -eq 2 ] && grep -q "is damaged" message.txt || fail "a damaged checkpoint was taken"
cp kept k.json.part
iterations=$(sed -n 2p kept | cut -d' ' -f1)
"$ltcfit" refine t.json -o k.json $long --resume --json > k.txt || fail "--resume"
python3 - "$iterations" <<'PY' || fail "what a resumed run says"
import json, sys
r = json.load(open('k.txt'))['refinement']
assert r['resumed_at'] == int(sys.argv[1]) <= r['iterations'] <= 15
assert json.load(open('k.json'))['provenance']['options']['refine_resumed_at'] == int(sys.argv[1])
PY
[ ! -e k.json.part ] || fail "the checkpoint was left"

# refused: exit, message, nothing written
ls > before
expect() {
  local rc=$1 message=$2
  shift 2
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local got=$?
  [ $got -eq "$rc" ] || fail "exit $got, not $rc: $*"
  grep -q -- "$message" stderr.txt || fail "no '$message' in the message of: $* -- $(cat stderr.txt)"
  rm -f stdout.txt stderr.txt
}
expect 2 "missing.json" refine missing.json -o x.json
expect 2 "is required" refine t.json
expect 2 "no/such" refine t.json -o no/such/x.json
expect 2 "--points = 15, must be in 16" refine t.json -o x.json --points 15
expect 2 "--iterations = 0, must be in 1" refine t.json -o x.json --iterations 0
expect 2 "--refine-points = 15" fit iso -o x.json --refine --refine-points 15
expect 2 "--refine-points needs --refine" fit iso -o x.json --refine-points 100
expect 2 "--stored-as Minv is for isotropic" refine t.json -o x.json --stored-as Minv
expect 2 "--keep-scale is for anisotropic" refine i.json -o x.json --keep-scale
expect 2 "--stored-as" refine i.json -o x.json --stored-as N
expect 2 "--seed" refine i.json -o x.json --seed -1
expect 2 "would overwrite this table" refine i.dds -o i.dds
expect 2 "would overwrite this part of the table" refine i.dds -o i.dds.json
expect 2 "is not a file" refine t.json -o /dev/stdout --resume
python3 - <<'PY'
import json
t = json.load(open('t.json'))
n = len(t['channels'])
def change(name, m):
    u = json.loads(json.dumps(t))
    u['data'][:9] = m
    json.dump(u, open(name, 'w'))
change('mirrored.json', [1, 0, 0, 0, -1, 0, 0, 0, 1])
change('flat.json', [1, 0, 0, 0, 1, 0, 0, 0, 0])
PY
for f in mirrored flat; do expect 2 "$f.json: node 0 has no matrix with det > 0" refine $f.json -o x.json $small; rm $f.json; done
cp t.json x.json.part
expect 2 "for the checkpoint of an interrupted run" refine x.json.part -o x.json
rm x.json.part
ls | diff before - || fail "refused runs wrote something"
cmp -s t.json before.json || fail "the input was changed"
"$ltcfit" refine -q t.json -o /dev/full $small 2>message.txt
[ $? -eq 1 ] || fail "no exit 1 where the table cannot be written"
finish
