# Tables as users have them: names of their own, other languages and number types, a second file, bad numbers.
. "$(dirname "$0")/common.sh" "$@"

# Every eighth node of the isotropic table as a three.js module has it, and what else its numbers come as.
"$ltcfit" export "$source_dir/data/ltc_iso.json" --profile three -q -o RectAreaLightTexturesLib.js 2>/dev/null ||
  "$ltcfit" export "$source_dir/data/ltc_iso.json" --format js -q -o RectAreaLightTexturesLib.js || fail "no module"
python3 - <<'PY'
import json, re, struct
text = open('RectAreaLightTexturesLib.js').read()
def numbers(name):
    return [float(v) for v in re.search(name + r'\s*=\s*\[(.*?)\]', text, re.S).group(1).split(',') if v.strip()]
mats = []
for name in ('LTC_MAT_1', 'LTC_MAT_2'):
    all = numbers(name)
    mats.append([all[4 * (64 * y + x) + c] for y in range(0, 64, 9) for x in range(0, 64, 9) for c in range(4)])
lists = [', '.join(repr(v) for v in m) for m in mats]
def source(path, form, names):
    open(path, 'w').write('\n'.join(form % (n, l) for n, l in zip(names, lists)) + '\n')
source('named.js', 'const %s = [%s];', ('LTC_MAT_1', 'LTC_MAT_2'))
source('other.js', 'var %s = [%s];', ('g_ltc_1', 'g_ltc_2'))
source('typed.ts', 'export const %s: number[] = [%s];', ('LTC_MAT_1', 'LTC_MAT_2'))
source('ltc.rs', 'pub const %s: [f32; 256] = [%s];', ('LTC_1', 'LTC_2'))
open('luts.json', 'w').write(json.dumps({'LTC_MAT_1': mats[0], 'LTC_MAT_2': mats[1]}))
def npy(path, values, kind='<f4', shape='(8, 8, 4)'):
    head = "{'descr': '%s', 'fortran_order': False, 'shape': %s, }" % (kind, shape)
    head += ' ' * (63 - (10 + len(head)) % 64) + '\n'
    code = kind[0] + {'f2': 'e', 'f4': 'f', 'f8': 'd'}[kind[1:]] * len(values)
    open(path, 'wb').write(b'\x93NUMPY\1\0' + struct.pack('<H', len(head)) + head.encode() + struct.pack(code, *values))
npy('ltc_mat.npy', mats[0])
npy('ltc_amp.npy', mats[1])
npy('wide_1.npy', mats[0], '<f8')
npy('wide_2.npy', mats[1], '>f8')
npy('small.npy', mats[1][:128], '<f4', '(8, 4, 4)')
bad = list(mats[0])
bad[(7 * 8 + 3) * 4 + 2] = float('nan')
npy('nan_1.npy', bad)
# 12 theta nodes of the layout of 2022
npy('theta12.npy', [1, 0, 0, 0, 1, 0, 0, 0, 1] * 96, '<f4', '(2, 2, 12, 2, 3, 3)')
# a .hdr of 2 x 1 pixels
open('light.hdr', 'wb').write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n' + bytes([128, 64, 32, 129] * 2))
open('cut.hdr', 'wb').write(b'#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 3\n' + bytes([128, 64, 32, 129] * 3)[:9])
PY
[ -s luts.json ] || fail "no inputs"

quick="--count 8 --samples 32 --directions 2 --quads 2 --lights 2 -q"
figures() { # FILE [OPTION...]: the figures without the name of the file
  "$ltcfit" score "$@" $quick --json 2>notes.txt | grep -v '"table"'
  [ "${PIPESTATUS[0]}" -eq 0 ] || fail "score $*: $(cat notes.txt)"
}
figures named.js >expected.txt
grep -q '"fresnel_error"' expected.txt || fail "no figures for Fresnel"
for table in other.js typed.ts ltc.rs luts.json; do
  figures $table >found.txt && cmp -s expected.txt found.txt || fail "$table gives other figures"
  [ -s notes.txt ] && fail "$table: $(cat notes.txt)"
done
for table in ltc_mat.npy wide_1.npy; do
  figures $table >found.txt && cmp -s expected.txt found.txt || fail "$table gives other figures"
  grep -q "$table: norm and Fresnel are taken from \(ltc_amp\|wide_2\).npy" notes.txt || fail "$table: silent"
done
cp ltc_mat.npy alone.npy
figures alone.npy >found.txt && cmp -s expected.txt found.txt && fail "norm and Fresnel from nowhere"
figures alone.npy --second ltc_amp.npy >found.txt && cmp -s expected.txt found.txt || fail "--second"
figures theta12.npy >found.txt || fail "theta12.npy"
for command in "export alone.npy -q -o a.h" "refine alone.npy -q --points 16 --iterations 1 -o r.json"; do
  "$ltcfit" $command --second ltc_amp.npy 2>notes.txt || fail "$command: $(cat notes.txt)"
  grep -q "taken from ltc_amp.npy" notes.txt || fail "$command: silent"
done
grep -q "a_amplitude" a.h || fail "export --second has no norm"

expect() { # MESSAGE COMMAND...
  local message=$1
  shift
  "$ltcfit" "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -qF -- "$message" stderr.txt || fail "no '$message' in the message of: $* -- $(cat stderr.txt)"
}
expect "8 x 8 x 1, 4 components" score alone.npy --second small.npy
expect "4 x 8 x 1, 4 components" export alone.npy --second small.npy -o x.h
expect "missing.npy" score alone.npy --second missing.npy
expect "has its norm and Fresnel" score named.js --second ltc_amp.npy
expect "nan_1.npy: texel y 7, x 3, component 2 is not finite" score nan_1.npy
expect "would overwrite" export alone.npy --second ltc_amp.npy --format npy -o ltc_amp.npy
expect "would overwrite" score ltc_mat.npy --report ltc_amp.npy
expect "cut.hdr: HDR: scanline 0: cut off" prefilter cut.hdr -o x.dds
[ -e x.h ] || [ -e x.dds ] && fail "a refused command wrote a file"

for picture in light.hdr "$source_dir/data/scenes/metal_rough.jpg"; do
  "$ltcfit" prefilter "$picture" -q --float --size 16 -o p.dds || fail "prefilter $picture"
done
finish
