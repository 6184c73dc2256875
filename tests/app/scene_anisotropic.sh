# A brushed scene: a table of a quarter of the full one's bytes, no more error; two tables where a scene has both.
. "$(dirname "$0")/common.sh" "$@"
scenes=$source_dir/data/scenes

"$ltcfit" fit --scene "$scenes/brushed.json" -o brushed.json --max-error 0.002 --verify --json \
  --full "$source_dir/data/ltc_aniso.json" >brushed.txt || fail "brushed.json"
python3 - <<'PY' || fail "brushed.json: too large, or too far off"
import json
[table] = json.load(open('brushed.txt'))['tables']
check = table['verification']
assert table['kind'] == 'anisotropic'
assert check['holds'], check['tailored']
assert table['bytes'] * 4 <= 8**4 * 24, table['bytes']
for ours, full in zip(check['light_errors']['tailored'], check['light_errors']['full']):
    assert ours <= 1.05 * full, check['light_errors']
PY

"$ltcfit" fit --scene "$scenes/lobby.json" -o lobby.json --max-error 0.004 --json >lobby.txt || fail "lobby.json"
python3 - <<'PY' || fail "lobby.json: not both tables"
import json, os
kinds = [t['kind'] for t in json.load(open('lobby.txt'))['tables']]
assert kinds == ['isotropic', 'anisotropic'], kinds
assert len(json.load(open('lobby-iso.json'))['axes']) == 2
assert len(json.load(open('lobby-aniso.json'))['axes']) == 4
assert not os.path.exists('lobby.json')
PY
"$ltcfit" check-gl lobby-aniso.json --random 8 --cost >gl.txt 2>&1 || grep -q "OpenGL" gl.txt || fail "check-gl: $(tail -3 gl.txt)"
finish
