# fit --axes: layouts by name and by list, from the option to the file, its provenance and its shader look-up.
. "$(dirname "$0")/common.sh" "$@"

quick="--preset fast --lights 16 --size 3x3x4x3"
fit() { # FILE OPTIONS...
  local file=$1
  shift
  "$ltcfit" fit aniso $quick -q -o "$file" "$@" || fail "fit aniso $*"
}

# names and lists say the same
fit default.json
fit named.json --axes 2022
cmp -s default.json named.json || fail "--axes 2022 is not the default"
grep -q -- '--axes' default.json && fail "a default run records --axes"
fit best.json --axes best
grep -q -- '"command":"ltcfit fit aniso --size 3x3x4x3 --axes best ' best.json || fail "the provenance of --axes best"
fit list.json --axes theta=linear:-0.3:0.2,alpha=sqrt,phi=sqrt-one-minus-cos
# the command in the file gives its bytes
command=$(python3 -c "import json; print(json.load(open('list.json'))['provenance']['command'])")
"$ltcfit" ${command#ltcfit } -q -o again.json && cmp -s list.json again.json || fail "again: $command"

python3 - <<'PY' || fail "the axes in the files"
import json, math
def axes(name): return {a['name']: a for a in json.load(open(name))['axes']}
a = axes('list.json')
assert a['alpha']['map'] == 'sqrt' and 'warp' not in a['alpha'], a['alpha']
assert abs(a['alpha']['values'][1] - 0.25) < 1e-12
assert a['theta']['warp'] == [-0.3, 0.2] and a['theta']['map'] == 'linear'
# t = s + s (1 - s) (A + B (1 - 2 s)) of each node is its number
for i, v in enumerate(a['theta']['values']):
    s = v / (math.pi / 2)
    assert abs(s + s * (1 - s) * (-0.3 + 0.2 * (1 - 2 * s)) - i / 3) < 1e-9, (i, v)
assert a['phi']['map'] == 'sqrt-one-minus-cos' and abs(a['phi']['values'][1] - math.acos(0.75)) < 1e-9
assert a['lambda'] == axes('default.json')['lambda']
assert axes('best.json') != axes('default.json')
PY

# exporters follow: the axes are in what they write, and the look-up is the table's own
for file in best list; do
  for format in ktx2 dds npy exr bin; do
    "$ltcfit" export -q $file.json -o $file.$format --format $format --layout channels || fail "export $file.$format"
    "$ltcfit" export -q $file.$format -o back.json && cmp -s back.json $file.json || fail "$file.$format and back"
  done
  "$ltcfit" export -q $file.json -o $file.h && "$ltcfit" score -q $file.h --count 4 >/dev/null || fail "$file.h"
  for language in glsl hlsl; do
    "$ltcfit" export -q $file.json -o $file.$language --format $language-lookup || fail "the look-up in $language"
  done
done
grep -q 'yEven' list.glsl && ! grep -q 'xEven' list.glsl || fail "the warp of list.glsl"
# the file of an engine has its own axes: refused, or interpolated where that is asked for
"$ltcfit" export -q best.json -o profile.h --profile anisotropic-2022 2>message.txt
[ $? -eq 2 ] && grep -q 'ltcfit fit aniso' message.txt && [ ! -e profile.h ] || fail "the profile: $(cat message.txt)"
"$ltcfit" export -q best.json -o profile.h --profile anisotropic-2022 --resample || fail "--resample"

# what a look-up costs is in the summary; of knots that none can be made
"$ltcfit" fit aniso $quick -o x.json --axes best --json > summary.json || fail "--json"
python3 - <<'PY' || fail "the cost in the summary"
import json
lookup = json.load(open('summary.json'))['lookup']
assert lookup['fetches'] == 6 and lookup['bytes'] == 3 * 3 * 4 * 3 * 3 * 4 * 2, lookup
PY
fit knots.json --axes theta=knots:0:40:70:90
python3 - <<'PY' || fail "the knots"
import json, math
theta = json.load(open('knots.json'))['axes'][2]
assert 'map' not in theta and [round(math.degrees(v), 9) for v in theta['values']] == [0, 40, 70, 90], theta
PY
"$ltcfit" score knots.json --points off-grid --count 4 >/dev/null || fail "score of knots"
"$ltcfit" export -q knots.json -o knots.ktx2 --layout channels && "$ltcfit" export -q knots.ktx2 -o back.json &&
  cmp -s back.json knots.json || fail "knots.ktx2 and back"
"$ltcfit" export -q knots.json -o knots.glsl --format glsl-lookup 2>message.txt
[ $? -eq 2 ] && grep -q "axis 'theta' has 4 nodes and no map" message.txt || fail "a look-up of knots: $(cat message.txt)"

# isotropic
"$ltcfit" fit iso --size 6x6 --lights 16 -q -o iso.json || fail "fit iso"
"$ltcfit" fit iso --size 6x6 --lights 16 -q -o warped.json --axes alpha=sqrt:0.3:-0.2 || fail "fit iso with a warp"
"$ltcfit" fit iso --size 6x6 --lights 16 -q -o iso_best.json --axes best || fail "fit iso --axes best"
"$ltcfit" export -q iso_best.json -o x.bin --profile babylon 2>message.txt
[ $? -eq 2 ] && grep -q 'ltcfit fit iso' message.txt || fail "the profile of an engine: $(cat message.txt)"
"$ltcfit" export -q iso_best.json -o iso_best.glsl --format glsl-lookup && grep -q "yEven" iso_best.glsl || fail "look-up of iso_best.json"
python3 - <<'PY' || fail "isotropic axes"
import json
theta, alpha = json.load(open('warped.json'))['axes']
assert theta == json.load(open('iso.json'))['axes'][0] and alpha['warp'] == [0.3, -0.2]
PY

# refused, with nothing written
refused() { # MESSAGE OPTIONS...
  local message=$1
  shift
  "$ltcfit" fit "$@" -q -o refused.json 2>message.txt
  [ $? -eq 2 ] && grep -qF -- "$message" message.txt || fail "fit $*: $(cat message.txt)"
  [ ! -e refused.json ] || fail "fit $* wrote a table"
}
refused "no axis 'beta'" aniso --axes beta=linear
refused "'cubic' is none of the maps" aniso --axes alpha=cubic
refused "alpha is given twice" aniso --axes alpha=sqrt,alpha=sqrt
refused "'x' is not a number" aniso --axes alpha=sqrt:x
refused "need 0.05 or more" aniso --axes alpha=linear:1.5
refused "sqrt-one-minus-cos is a map of angles" aniso --axes alpha=sqrt-one-minus-cos
refused "3 knots for 8 nodes" aniso --axes theta=knots:0:45:90
refused "does not increase" aniso --size 8x8x3x8 --axes theta=knots:0:0:90
refused "the last 90 (degrees)" aniso --size 8x8x3x8 --axes theta=knots:0:45:80
refused "'2022' is neither 2016, 2017, best nor AXIS=MAP" iso --axes 2022
refused "no axis 'phi' (theta, alpha)" iso --axes phi=linear
finish
