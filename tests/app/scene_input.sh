# Scenes that ltcfit scene and fit --scene cannot make a table of: what is said, and that nothing is written.
. "$(dirname "$0")/common.sh" "$@"

# A triangle, 36 bytes of positions, of a material without reflection: no table is needed.
gltf() {
  cat <<EOT
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
 "materials": [{"name": "chalk", "pbrMetallicRoughness": {"metallicFactor": 0},
                "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}],
 "accessors": [{"bufferView": 0, "componentType": $1, "count": 3, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 36}],
 "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}
EOT
}
gltf 5126 >dull.gltf
gltf 5127 >s5127.gltf
printf '{"asset": {"version": "2.0"}}' >empty.gltf
printf '{"format": "ltc-scene", "version": 1, "materials": [{"name": "soot", "roughness": 0.5, "f0": 0, "f90": 0}]}' >soot.json

# expect MESSAGE COMMAND...: exit 2, and the message on one line
expect() {
  local message=$1
  shift
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -qF -- "$message" stderr.txt || fail "no '$message' in '$(head -c 400 stderr.txt)': $*"
  [ ! -s stdout.txt ] || fail "it says something else besides: $*"
}
# The plan, which is what tells why, is made and written all the same.
for scene in dull.gltf empty.gltf soot.json; do
  "$ltcfit" scene $scene -o plan.json >plan.txt || fail "scene $scene"
  grep -qF "No table is needed: " plan.txt || fail "scene $scene says not why: $(cat plan.txt)"
  grep -qF "wrote plan.json" plan.txt || fail "scene $scene: no plan"
  expect "plan.json: the plan has no tables, since its scene needs none: x.json was not written" \
    fit --plan plan.json -o x.json
  rm plan.json
done
expect "dull.gltf: No table is needed: no lobe reflects anything, F0 and F90 are 0 ('chalk'). x.json was not written" \
  fit --scene dull.gltf -o x.json
expect "empty.gltf: No table is needed: nothing that the scene shows has a specular lobe. x.json was not written" \
  fit --scene empty.gltf -o x.json -q
expect "F0 and F90 are 0 ('soot')" fit --scene soot.json -o x.json --json --max-bytes 400

# Types that glTF does not have.
expect "s5127.gltf: accessor 0: componentType is 5127; glTF has 5120 (BYTE), 5121" scene s5127.gltf
expect "accessor 0: componentType is 5127" fit --scene s5127.gltf -o x.json

# Gigabytes, before they are asked for.
python3 - <<'PY'
with open('materials.gltf', 'w') as f:
    f.write('{"asset": {"version": "2.0"}, "materials": [' + '{},' * (4 << 20) + '{}]}')
with open('big.json', 'w') as f:
    f.write('{"format": "ltc-plan", "version": 1, "tables": [' + '[],' * (9 << 20) + '[]]}')
PY
(
  ulimit -v 1000000 # KiB
  expect "its JSON would take more than 4294967296 bytes of memory" scene materials.gltf
  expect "which would take some 2444231348 bytes of memory" fit --plan big.json -o x.json
  exit $failures
) || fail "gigabytes"
expect "/dev/zero: larger than 268435456 bytes" fit --plan /dev/zero -o x.json
[ -e x.json ] && fail "a table was written"
finish
