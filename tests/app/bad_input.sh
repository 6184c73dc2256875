# Bad input: exit 2, a message that names what is wrong, nothing written.
. "$(dirname "$0")/common.sh" "$@"

"$ltcfit" fit iso -q -o good.json --size 4x4 --lights 32 || fail "cannot make the good table"
python3 - <<'PY'
import json
text = open('good.json').read()
open('truncated.json', 'w').write(text[:len(text) // 2])
open('empty.json', 'w').write('')
open('text.json', 'w').write('hello\n')
def change(name, f):
    t = json.loads(text)
    f(t)
    open(name, 'w').write(json.dumps(t))
change('count.json', lambda t: t['data'].pop())
change('nan.json', lambda t: t['data'].__setitem__(3, float('nan')))
change('null.json', lambda t: t['data'].__setitem__(3, None))
change('axis.json', lambda t: t['axes'][0]['values'].__setitem__(1, 0.0))
change('negative.json', lambda t: t['axes'][1]['values'].__setitem__(0, -0.1))
change('version.json', lambda t: t.__setitem__('version', 9))
PY
ls > before

# expect MESSAGE COMMAND...
expect() {
  local message=$1
  shift
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -q -- "$message" stderr.txt || fail "no '$message' in the message of: $* -- $(cat stderr.txt)"
  [ "$(grep -c . stderr.txt)" -le 3 ] || fail "long message: $*"
  rm -f stdout.txt stderr.txt
}

for f in truncated nan; do expect "$f.json: not valid JSON" score $f.json; done
expect "empty.json: is empty" score empty.json
expect "text.json: not a table" score text.json
expect "missing.json: cannot read" score missing.json
expect "count.json: data: 111 numbers" score count.json
expect "null.json: data.3. is not a number" score null.json
expect "axis.json: axis 'theta' values.1. does not increase" score axis.json
expect "negative.json: axis 'alpha' values.0." score negative.json
expect "version.json: version 9" score version.json
expect ".: is a folder" score .
expect "missing.json" score good.json --against missing.json
expect "--count 0" score good.json --points off-grid --count 0
expect "--points" score good.json --points everywhere
expect "would overwrite this table" score good.json --count 3 --report good.json
cp good.json second.json
expect "would overwrite this table" score good.json --count 3 --against second.json --report ./second.json
rm second.json
expect "would overwrite this table" export good.json -o good.json
expect "--min-alpha" score good.json --min-alpha -0.5
expect "no point is left" score good.json --points extreme --min-alpha 0.9
for f in truncated count nan null axis version missing; do expect "$f.json" export $f.json -o x.h; done
expect "no/such" export good.json -o no/such/x.h
expect "--coefficients is for --format chebyshev" export good.json -o x.h --coefficients 200
for bytes in 94 642 many -1; do expect "--coefficients" export good.json --format chebyshev -o x --coefficients $bytes; done
expect "holds float32 only" export good.json --format chebyshev -o x --precision half
expect "one layout only" export good.json --format chebyshev -o x --layout channels
expect "160 coefficients are too many for 16 nodes; 48 at most" export good.json --format chebyshev -o x
expect "several files" export "$source_dir/data/ltc_iso.json" --format chebyshev -o /dev/stdout
expect "for isotropic tables" export "$source_dir/data/ltc_aniso.json" --format chebyshev -o x
sed 's/"turn"/"torn"/' "$source_dir/data/ltc_iso.cheb.json" > torn.json
expect "torn.json: functions.turn is missing" score torn.json
cp "$source_dir/data/ltc_iso.cheb.json" again.cheb.json
expect "would overwrite this table" export again.cheb.json --format chebyshev -o again
rm torn.json again.cheb.json
expect "is a folder" export good.json -o .
expect "--output is required" export good.json
expect "--size '0x0x0'" fit iso -o x.json --size 0x0x0
expect "--size '64'" fit iso -o x.json --size 64
expect "--size '4x-4'" fit iso -o x.json --size 4x-4
expect "0 theta nodes" fit iso -o x.json --size 0x4
expect "1 theta nodes" fit iso -o x.json --size 1x4
expect "1 alpha nodes" fit iso -o x.json --size 4x1
expect "99999 alpha nodes" fit iso -o x.json --size 4x99999
expect "--alpha-floor" fit iso -o x.json --alpha-floor -0.1
expect "--alpha-floor" fit iso -o x.json --alpha-floor nan
expect "--alpha-floor" fit iso -o x.json --alpha-floor 0.5
expect "--alpha-floor" fit iso -o x.json --alpha-floor abc
expect "--theta-max" fit iso -o x.json --theta-max 1.6
expect "--theta-max" fit iso -o x.json --theta-max 0.5
expect "--samples" fit iso -o x.json --fitter sw --samples 1
expect "--samples" fit iso -o x.json --fitter sw --samples 99999999999
expect "--samples needs" fit iso -o x.json --samples 1024
expect "--directions needs" fit iso -o x.json --directions 64
expect "--lights" fit iso -o x.json --lights 15
expect "--lights needs --fitter light" fit iso -o x.json --fitter sw --lights 64
expect "--weighting needs --fitter light" fit aniso -o x.json --fitter l3 --weighting mixed
expect "--weighting" fit iso -o x.json --weighting heavy
expect "--size-exponent" fit iso -o x.json --size-exponent 9
expect "--size-exponent" fit iso -o x.json --size-exponent nan
expect "--leak-weight" fit iso -o x.json --leak-weight nan
expect "--integrator" score good.json --integrator sphere
expect "--family" fit iso -o x.json --family 5
expect "--axes" fit iso -o x.json --axes 2018
expect "--fitter" fit iso -o x.json --fitter magic
expect "--seed" fit iso -o x.json --seed -1
expect "name the same file" fit iso -o x.json --report x.json
expect "--prefix" export good.json -o y.json --prefix a
expect "not known" export good.json -o x.png --format png
expect "holds float32 only" export good.json -o x.h --precision half
expect "--precision" export good.json -o x.dds --precision double
expect "--layout" export good.json -o x.dds --layout planes
expect "has one layout only" export good.json -o x.js --layout channels
expect "--dds-header" export good.json -o x.ktx2 --dds-header legacy
expect "--uncompressed" export good.json -o x.dds --uncompressed
expect "--resample needs" export good.json -o x.dds --resample
expect "not known" export good.json -o x --profile engine
expect "a profile settles this" export good.json -o x --profile three --format js
expect "ltcfit fit iso --size 64x64 --axes 2017" export good.json -o x.js --profile three
expect "ltcfit fit iso --size 32x32 --axes 2016" export good.json -o x --profile o3de
expect "ltcfit fit aniso" export good.json -o x.h --profile anisotropic-2022 --resample
expect "is a file" export good.json -o good.json --profile godot --resample
expect "no/such" export good.json -o no/such --profile godot --resample
expect "what format?" export good.json -o x.png
expect "--report needs" export good.json -o x.dds --report
expect "several files" export good.json --format dds --dds-header legacy -o /dev/stdout
expect "holds floats" export good.json -o x.js --profile three --resample --report
expect "fits none of the profiles" export good.json -o engines --profile all
expect "a table to read is required" export -o x.h
expect "--tolerance" compare good.json good.json --tolerance -1
expect "--table" pareto --table both
expect "--entries" pareto --entries 0
expect "--entries" pareto --entries 1001
expect "--entries" pareto --entries nan
expect "--repeats" pareto --repeats 0
expect "--repeats" pareto --repeats 2.5
expect "--fitter" pareto --fitter magic
expect "--seed" pareto --seed -1
expect "--seed" pareto --seed inf
expect "--samples" pareto --samples 15
expect "--lights" pareto --lights 0
expect "--threads" pareto --threads -1
expect "no/such" pareto -o no/such/p.json
expect "is a folder" pareto -o .
expect "not expected: --preset" pareto --preset
expect "missing.json" compare good.json missing.json
expect "is required" compare good.json
"$ltcfit" export -q good.json -o t.dds || fail "export of a DDS"
head -c 100 t.dds > cut.dds
expect "cut.dds: not a DDS file, or cut off" score cut.dds
expect "t.dds.json: describes a texture file" score t.dds.json
sed 's/"scale": 1.0/"scale": 3.0/' t.dds.json > cut.dds.json; cp t.dds cut.dds
expect "cut.dds.json: matrix.scale" score cut.dds
expect "would overwrite this part of the table" export t.dds -o t.dds.json --format json
cp t.dds.json cut.dds.json; cp good.json cut.dds; "$ltcfit" export -q good.json -o cut.dds --precision half && cp t.dds.json cut.dds.json
expect "cut.dds.json: describes another file" score cut.dds
rm t.dds t.dds.json cut.dds cut.dds.json
# a table without norm and Fresnel: no engine's file, other forms yes
python3 - <<'PY'
import json
t = json.load(open('good.json'))
t['channels'] = t['channels'][:5]
t['data'] = [x for i, x in enumerate(t['data']) if i % 7 < 5]
json.dump(t, open('plain.json', 'w'))
PY
expect "needs the channel norm" export plain.json -o x.js --profile three --resample
"$ltcfit" export -q plain.json -o x.dds && "$ltcfit" score -q x.dds --count 3 >/dev/null || fail "a table without norm"
"$ltcfit" compare good.json plain.json --tolerance 2 >/dev/null 2>&1
[ $? -eq 3 ] || fail "no exit 3 where only one table has a norm"
rm plain.json x.dds x.dds.json
# profiles of several files: nothing is written over the input
mkdir folder; "$ltcfit" export -q good.json -o folder --profile selfshadow-dds --resample || fail "selfshadow-dds"
expect "would overwrite this table" export folder/ltc_1.dds -o folder --profile selfshadow-dds
rm -r folder
expect "needs --fitter l3" fit iso -o x.json --family 3
expect "needs --fitter l3" fit iso -o x.json --max-evaluations 5
expect "needs --fitter light, sw" fit iso -o x.json --fitter l3 --preset fast
expect "needs --fitter sw-sgd" fit aniso -o x.json --preset paper
expect "needs --fitter light or sw;" fit aniso -o x.json --fitter sw-sgd --preset fine
expect "--resume" fit iso -o x.json --fitter l3 --resume
expect "--leak-weight" fit iso -o x.json --leak-weight -1
expect "--leak-weight needs" fit aniso -o x.json --fitter l3 --leak-weight 1
expect "--directions" fit iso -o x.json --fitter sw --directions 2
expect "--size '8x8x8'" fit aniso -o x.json --size 8x8x8
expect "--size '8x8x8x8x8'" fit aniso -o x.json --size 8x8x8x8x8
expect "--size '8x8x8x'" fit aniso -o x.json --size 8x8x8x
expect "lambda nodes" fit aniso -o x.json --size 8x1x8x8
expect "phi nodes" fit aniso -o x.json --size 8x8x8x65
expect "--alpha-floor" fit aniso -o x.json --alpha-floor 0.2
expect "--theta-max" fit aniso -o x.json --theta-max 1.58
expect "no/such" fit aniso -o no/such/x.json
expect "--alpha-x" fit entry --alpha-x 2
expect "--theta" fit entry --alpha-x 0.5 --theta 91
echo "ltcfit-checkpoint 2 9 another command" > x.json.part
expect "x.json.part: of a run that was interrupted" fit aniso -o x.json --size 2x2x2x2
expect "x.json.part: holds another run" fit aniso -o x.json --size 2x2x2x2 --resume
echo "something else, longer than any header of a checkpoint would be, whatever the options were, for certain: and then some more of it to be sure that it is longer than the whole of the command line" > x.json.part
expect "x.json.part: not a checkpoint" fit aniso -o x.json --size 2x2x2x2 --resume
rm x.json.part; mkfifo x.json.part
expect "x.json.part: not a file" fit aniso -o x.json --size 2x2x2x2 --resume
rm x.json.part
expect "must be numbers" fit entry --alpha-x nan
expect "must be a number" score good.json --min-alpha nan
expect "name the same file" fit aniso -o x.json --report ./x.json
expect "name the same file" fit aniso -o x.json --report x.json.part
expect "theta-max or --alpha-floor" fit aniso -o x.json --size 2x2x2x2 --theta-max 1e-9
expect "--threads" fit iso -o x.json --threads -1
expect "not expected: --unknown" fit iso -o x.json --unknown
expect "--output is required" fit iso
expect "no/such" fit iso -o no/such/x.json
expect "no/such" fit iso -o x.json --report no/such/x.csv
expect "need --plan or --scene" fit
expect "subcommand is required"
expect "unknown option .--foo" --foo
expect "unknown command .nonsense." nonsense x

# the quality gate: exit 3, no table, but the report that tells why
"$ltcfit" fit iso --fitter l3 -o x.json --size 8x8 --alpha-floor 1e-5 --max-evaluations 1 --report r.csv >/dev/null 2>stderr.txt
[ $? -eq 3 ] || fail "no exit 3 for unusable entries"
grep -q "entries are unusable" stderr.txt || fail "no message for unusable entries"
[ ! -e x.json ] && grep -q ",0$" r.csv || fail "a table was written, or no report"
rm -f r.csv stderr.txt
# what goes to a stream is the data alone
"$ltcfit" export good.json --format json -o /dev/stdout 2>/dev/null | cmp - good.json || fail "notes among the data"
# compare: equal, different
"$ltcfit" compare good.json good.json --tolerance 0 >/dev/null || fail "compare of equal tables"
"$ltcfit" export -q good.json -o h.npy --precision half && "$ltcfit" compare good.json h.npy --tolerance 1e-6 >/dev/null 2>&1
[ $? -eq 3 ] || fail "no exit 3 for different tables"
rm h.npy h.npy.json
# a closed or full stderr does not change the exit code, a full stdout is a failure
for target in /dev/full; do
  [ -e $target ] || continue
  "$ltcfit" score missing.json 2>$target; [ $? -eq 2 ] || fail "full stderr"
  "$ltcfit" --help >$target 2>/dev/null; [ $? -eq 1 ] || fail "--help to a full disk"
  "$ltcfit" score -q good.json --count 2 >$target 2>/dev/null; [ $? -eq 1 ] || fail "score to a full disk"
done
"$ltcfit" score missing.json 2>&-; [ $? -eq 2 ] || fail "closed stderr"
python3 -c "print('{\"format\":\"ltc-table\",\"version\":' + '[' * 200000 + ']' * 200000 + '}')" > deep.json
expect "deep.json: version of another type" score deep.json
rm deep.json
# links keep pointing, modes stay
cp good.json target.json; chmod 600 target.json; ln -s target.json link.json
"$ltcfit" export -q good.json -o link.json || fail "export through a link"
[ -L link.json ] && [ "$(stat -c %a target.json)" = 600 ] || fail "the link or the mode of its target is gone"
rm link.json target.json

[ "$(ls)" = "$(cat before)" ] || fail "files were left: $(ls | diff before - | tr '\n' ' ')"
"$ltcfit" --help | grep -q "Exit codes" || fail "--help"
"$ltcfit" --version | grep -q "^ltcfit [0-9]" || fail "--version"
for c in "fit iso" score export compare pareto; do "$ltcfit" $c --help | grep -q -- "--" || fail "$c --help"; done
finish
