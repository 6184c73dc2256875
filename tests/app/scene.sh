# ltcfit scene, fit --plan and fit --scene: the right tables, of the size that is said, within the bound.
. "$(dirname "$0")/common.sh" "$@"
scenes=$source_dir/data/scenes

# One isotropic roughness: one row, no other table, and why.
"$ltcfit" scene "$scenes/plain.gltf" -o plain.json >plain.txt || fail "plain.gltf"
for part in "satin" "Isotropic table" "all lobes have roughness (the root of alpha) 0.4, one node" "2 fetches" \
            "fresnel: F0 differs from F90" "ltcfit fit --plan plain.json"; do
  grep -qF "$part" plain.txt || fail "plain.gltf: no '$part'"
done
grep -q "Anisotropic table" plain.txt && fail "plain.gltf: a table of four dimensions"
"$ltcfit" fit --plan plain.json -o row.json --json >row.txt || fail "fit --plan plain.json"
python3 - <<'PY' || fail "row.json is not one row"
import json
summary = json.load(open('row.txt'))
[table] = summary['tables']
axes = {a['name']: a['values'] for a in json.load(open('row.json'))['axes']}
assert len(axes['alpha']) == 1 and abs(axes['alpha'][0] - 0.16) < 1e-7, axes
assert 4 < len(axes['theta']) < 24, axes
assert table['bytes'] == 12 * len(axes['theta']), table
assert table['error']['mean'] <= 0.001, table
assert table['max_error'] == 0.001
PY

# The same at once; any number of threads.
"$ltcfit" fit --scene "$scenes/plain.gltf" -o at_once.json -q --threads 1 || fail "fit --scene"
[ "$(grep -v provenance at_once.json)" = "$(grep -v provenance row.json)" ] || fail "--scene is not as --plan"

# The command that the file names makes the same file, and that of --scene too.
mkdir again
cp plain.json again
cp "$scenes/plain.gltf" again
command=$(python3 -c "import json; print(json.load(open('at_once.json'))['provenance']['command'].removeprefix('ltcfit '))")
# shellcheck disable=SC2086
(cd again && "$ltcfit" $command -o at_once.json -q) || fail "$command"
cmp -s at_once.json again/at_once.json || fail "$command: another file"
grep -q 'ltcfit fit --plan plain.json' row.json || fail "another command in row.json: $(grep command row.json)"

# What it is shipped as has the bytes that are stated.
"$ltcfit" export row.json --format npy --layout lean --precision half -o row.npy >/dev/null 2>&1 || fail "export lean"
python3 - <<'PY' || fail "exported bytes are not those stated"
import glob, json
stated = json.load(open('row.txt'))['tables'][0]['bytes']
payload = 0
for name in glob.glob('row-*.npy'):
    data = open(name, 'rb').read()
    payload += len(data) - 10 - int.from_bytes(data[8:10], 'little')
assert payload == stated, (payload, stated)
PY
"$ltcfit" export row.json --format glsl-lookup -o row.glsl >/dev/null || fail "export glsl-lookup"
grep -q "ltcSceneFetch(" row.glsl || fail "no look-up in row.glsl"

# Roughness 0.3 to 0.7: an eighth of the full table's bytes, no more error.
"$ltcfit" fit --scene "$scenes/satin.json" -o satin.json --max-error 0.0005 --verify --json \
  --full "$source_dir/data/ltc_iso.json" >satin.txt || fail "satin.json"
python3 - <<'PY' || fail "satin.json: too large, or too far off"
import json
[table] = json.load(open('satin.txt'))['tables']
check = table['verification']
assert check['holds'] and check['tailored']['mean'] <= 0.0005, check
assert table['bytes'] * 8 <= 64 * 64 * 12, table['bytes']
# unseen errors against the truth, light_s, light_m and light_l, within 5 % of the full table's
for ours, full in zip(check['light_errors']['tailored'], check['light_errors']['full']):
    assert ours <= 1.05 * full, check['light_errors']
# a bound of means: so are these
assert check['scenes']['tailored_rmse'] <= check['scenes']['full_rmse'] + 0.0005, check['scenes']
PY

# Best within some bytes.
"$ltcfit" fit --scene "$scenes/satin.json" -o small.json --max-bytes 400 --json >small.txt || fail "--max-bytes"
python3 -c "import json; b = json.load(open('small.txt'))['tables'][0]['bytes']; assert 300 < b <= 400, b" ||
  fail "--max-bytes 400: another size"

# Views from above only: verified in pictures of such views.
"$ltcfit" fit --scene "$scenes/plain.gltf" --views 0 40 -o above.json --verify --full "$source_dir/data/ltc_iso.json" --json \
  >above.txt || fail "--views"
python3 - <<'PY' || fail "--views: $(tail -c 600 above.txt)"
import json
scenes = json.load(open('above.txt'))['tables'][0]['verification']['scenes']
assert scenes['count'] > 4 and scenes['tailored_rmse'] <= scenes['full_rmse'] + 0.001, scenes
PY

# A mirror: the bound is the full table's unless one insists.
echo '{"format":"ltc-scene","version":1,"name":"mirror","materials":[{"name":"m","roughness":0,"f0":1}]}' >mirror.json
"$ltcfit" scene mirror.json >mirror.txt || fail "mirror.json"
grep -q "is more than the full table keeps to" mirror.txt || fail "mirror.json: the bound is not explained"
"$ltcfit" scene mirror.json --max-error 0.001 >mirror.txt
[ $? -eq 3 ] || fail "mirror.json at 0.001 is within reach"

# Out of reach: exit 3, nothing written.
"$ltcfit" fit --scene "$scenes/satin.json" -o none.json --max-error 0.0005 --max-bytes 400 >none.txt 2>&1
[ $? -eq 3 ] || fail "out of reach is not exit 3"
grep -q "out of reach within 400 bytes" none.txt || fail "out of reach: $(cat none.txt)"
[ -e none.json ] && fail "a table was written that breaks its bound"

# expect MESSAGE COMMAND...: exit 2, and the message
expect() {
  local message=$1
  shift
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -qF -- "$message" stderr.txt || fail "no '$message' in '$(head -c 300 stderr.txt)': $*"
}
head -c 300 "$scenes/plain.gltf" >cut.gltf
head -c 500 "$scenes/lamp.glb" >cut.glb
sed 's/ltc-plan/ltc-paln/' plain.json >other.json
expect "cut.gltf" scene cut.gltf
expect "cut.glb" scene cut.glb
expect "missing.gltf" scene missing.gltf
expect "format is not" fit --plan other.json -o x.json
expect "is what is read" fit --plan plain.json -o plain.json
expect "--max-error needs --scene" fit --plan plain.json -o x.json --max-error 0.1
expect "exclude each other" fit --plan plain.json --scene cut.gltf -o x.json
expect "--output is required" fit --plan plain.json
expect "--full needs --verify" fit --plan plain.json -o x.json --full row.json
expect "--views" scene "$scenes/plain.gltf" --views 60 20
expect "excludes --max-error" fit --max-error 0.1 iso -o x.json
[ -e x.json ] && fail "bad input left a table"
finish
