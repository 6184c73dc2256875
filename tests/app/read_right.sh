# Tables that are read wrong: told by every command, exit 3 where a check is made; right ones pass without a word.
. "$(dirname "$0")/common.sh" "$@"

# The isotropic table as three.js has it, and with rows for columns; 8 x 8 of its texels, the same.
"$ltcfit" export "$source_dir/data/ltc_iso.json" --profile three --resample -q -o ltc.js || fail "no module"
python3 - <<'PY'
import re, struct
text = open('ltc.js').read()
tables = [[float(v) for v in re.search(name + r'\s*=\s*\[(.*?)\]', text, re.S).group(1).split(',') if v.strip()]
          for name in ('LTC_MAT_1', 'LTC_MAT_2')]
def npy(path, values, n, order='C'):
    head = "{'descr': '<f4', 'fortran_order': False, 'shape': (%d, %d, 4), }" % (n, n)
    head += ' ' * (63 - (10 + len(head)) % 64) + '\n'
    open(path, 'wb').write(b'\x93NUMPY\1\0' + struct.pack('<H', len(head)) + head.encode() +
                           struct.pack('<%df' % len(values), *values))
for t, table in enumerate(tables, 1):
    for name, rows in (('', range(64)), ('small_', range(0, 64, 9))):
        n = len(rows)
        npy('%sright_%d.npy' % (name, t), [table[4 * (64 * y + x) + c] for y in rows for x in rows for c in range(4)], n)
        npy('%sturned_%d.npy' % (name, t), [table[4 * (64 * x + y) + c] for y in rows for x in rows for c in range(4)], n)
PY
[ -s small_turned_2.npy ] || fail "no inputs"

quick="--count 8 --samples 32 --directions 2 --quads 2 --lights 2 -q"
run() { # EXIT COMMAND...: runs it with stderr in stderr.txt
  local expected=$1
  shift
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq "$expected" ] || fail "exit $rc, not $expected: $* -- $(cat stderr.txt)"
}
complains() {
  grep -q "warning: $1: read with axes exchanged it fits [0-9.]* times better (0.00[0-9]* against 0.5" stderr.txt ||
    fail "no verdict on $1: $(cat stderr.txt)"
  grep -q "warning: $1: limit of GGX tables not kept: .*texel y [0-9]*, x [0-9]* (theta [0-9.]* degrees, alpha [0-9.e-]*)" \
    stderr.txt || fail "no texel for $1"
}
is_quiet() { grep -q "warning" stderr.txt && fail "$1: $(cat stderr.txt)"; }

run 0 score small_turned_1.npy $quick && complains small_turned_1.npy
run 0 score small_right_1.npy $quick && is_quiet small_right_1.npy
run 0 export small_turned_1.npy -q -o turned.h && complains small_turned_1.npy
run 0 export turned_1.npy --profile three -q -o turned.js && complains turned_1.npy
run 0 export right_1.npy --profile three -q -o right.js && is_quiet right_1.npy
run 0 score small_right_1.npy --against small_turned_1.npy $quick && complains small_turned_1.npy
gl="--random 0 --width 16 --height 16 --samples 128 --alpha-x 0.3 -q"
if "$ltcfit" check-gl --help >/dev/null 2>&1 && "$ltcfit" check-gl right_1.npy $gl >gl.txt 2>&1; then
  run 3 check-gl small_turned_1.npy $gl && complains small_turned_1.npy
  grep -q "small_turned_1.npy FAILED: its numbers are not what they are read as" stdout.txt || fail "check-gl: $(cat stdout.txt)"
  run 0 check-gl small_right_1.npy $gl && is_quiet small_right_1.npy
else
  echo "not tried: check-gl ($(tail -1 gl.txt))"
fi
page="--points 4 --samples 64 --directions 2 --quads 2 --lights 2"
if "$ltcfit" report small_right_1.npy $page -q -o right.html >report.txt 2>&1; then
  run 3 report small_turned_1.npy $page --gate -o turned.html
  complains small_turned_1.npy
  grep -q "not kept: Misfit as read, over the best other reading's: .*read with axes exchanged" stdout.txt ||
    fail "report: $(cat stdout.txt)"
  run 0 report small_turned_1.npy $page -o turned.html
  run 0 report small_right_1.npy $page -o right.html && is_quiet small_right_1.npy
  grep -q "not kept: \(Misfit\|Limits\)" stdout.txt && fail "report: $(cat stdout.txt)"
else
  echo "not tried: report ($(tail -1 report.txt))"
fi

# Every fitter at its least effort, with its options of another kind.
for fit in "iso --size 4x4" "iso --size 4x4 --axes 2016" "iso --size 3x5 --fitter l3" "iso --size 4x4 --fitter light" \
  "iso --size 4x4 --alpha-floor 0.01 --theta-max 1.4" "aniso --size 2x2x3x2" "aniso --size 3x3x3x2 --symmetry after"; do
  run 0 fit $fit -q -o small.json
  run 0 score small.json $quick && is_quiet "fit $fit"
done

# Files of engines without their descriptions, and what says what they are.
figures() { "$ltcfit" score "$@" $quick --json 2>stderr.txt | grep -v '"table"'; }
for profile in godot o3de; do
  run 0 export "$source_dir/data/ltc_iso.json" --profile $profile --resample -q -o $profile
  first=$(ls $profile/*.dds | grep -v "lut2\|amp")
  figures $first >described.txt
  rm $profile/*.json
  figures $first >found.txt
  cmp -s described.txt found.txt || fail "$profile: other figures without its description"
  grep -q "note: $first: taken for the layout of " stderr.txt || fail "$profile: silent: $(cat stderr.txt)"
  is_quiet $profile
  figures $first --read-as $profile >found.txt
  cmp -s described.txt found.txt || fail "--read-as $profile: other figures"
  run 0 score $first --read-as 2017 $quick
  grep -q "warning: $first: \(read with\|limit\)" stderr.txt || fail "$profile as 2017: $(cat stderr.txt)"
done
run 0 export "$source_dir/data/ltc_iso.json" --profile unity-hdrp --resample -q -o LtcData.GGX.cs
run 0 score LtcData.GGX.cs $quick && is_quiet HDRP
grep -q "taken for the layout of hdrp" stderr.txt || fail "HDRP: $(cat stderr.txt)"
run 0 export LtcData.GGX.cs --read-as hdrp -q -o hdrp.h && is_quiet hdrp.h
run 2 score LtcData.GGX.cs --read-as 2018 $quick
grep -q "layout '2018' is not one for these numbers (there are 2017, 2016 or o3de, hdrp or unity-hdrp, godot)" stderr.txt ||
  fail "2018: $(cat stderr.txt)"
run 2 score "$source_dir/data/ltc_iso.json" --read-as 2017 $quick
grep -q "says itself what its numbers mean" stderr.txt || fail "JSON --read-as: $(cat stderr.txt)"
finish
