# ltcfit prefilter: files, messages, the same bytes for any number of threads.
. "$(dirname "$0")/common.sh" "$@"

# an 8 x 4 PNG of 8 bits, written by hand; red grows to the right
python3 - <<'PY'
import struct, zlib
def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
def png_of(width, height):
    rows = b''.join(b'\0' + b''.join(bytes((32 * x % 256, 64 * y, 200)) for x in range(width))
                    for y in range(height))
    return (b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', width, height, 8, 2, 0, 0, 0))
            + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b''))
png = png_of(8, 4)
open('picture.png', 'wb').write(png)
open('thin.png', 'wb').write(png_of(65, 1))
open('cut.png', 'wb').write(png[:-30])
open('text.png', 'w').write('hello')
PY

for f in a.ktx2 a.dds a.exr; do
  "$ltcfit" prefilter picture.png -q -o $f >out.txt || fail "$f"
  [ -s $f ] || fail "$f is not there"
  [ -s out.txt ] && fail "$f: --quiet prints"
done
[ -s a.dds.json ] || fail "no metadata beside a.dds"
grep -q '"margin": 0.5' a.dds.json || fail "a.dds.json: no margin"
for f in a.ktx2 a.exr; do grep -aq ltc-light-texture $f || fail "$f: no metadata"; done
"$ltcfit" prefilter picture.png -o b.ktx2 | grep -q "margin = 0.5, lodScale = .*; made for a light of aspect = 2$" ||
  fail "the parameters are not printed"
cmp -s a.ktx2 b.ktx2 || fail "a second run writes other bytes"
for threads in 1 3; do
  "$ltcfit" prefilter picture.png -q --size 128 --threads $threads -o t$threads.dds || fail "threads $threads"
done
cmp -s t1.dds t3.dds || fail "the bytes depend on the threads"
# 16 x 16 texels and their mip maps, 4 channels, behind a header of 148
[ "$(wc -c <a.dds)" -eq $((148 + 341 * 8)) ] || fail "a.dds: $(wc -c <a.dds) bytes"
"$ltcfit" prefilter picture.png -q --float -o f.dds
[ "$(wc -c <f.dds)" -eq $((148 + 341 * 16)) ] || fail "f.dds: $(wc -c <f.dds) bytes"
"$ltcfit" prefilter picture.png -q --uncompressed -o u.ktx2 || fail "--uncompressed"
cmp -s u.ktx2 a.ktx2 && fail "--uncompressed changes nothing"
# the picture's own aspect, where none is given
"$ltcfit" prefilter picture.png -q --aspect 2 -o c.ktx2 && cmp -s c.ktx2 a.ktx2 || fail "--aspect 2 is not the default"
"$ltcfit" prefilter picture.png -q --aspect 1 -o c.ktx2 && cmp -s c.ktx2 a.ktx2 && fail "--aspect changes nothing"
grep -q '"aspect": 2.0' a.dds.json || fail "a.dds.json: no aspect"
grep -q 'round on a light of width / height = aspect' a.dds.json || fail "a.dds.json: aspect is not explained"
"$ltcfit" prefilter thin.png -q --aspect 64 -o thin.dds || fail "a thin picture with an aspect given"
"$ltcfit" prefilter picture.png -q --json --margin 0.25 -o j.exr | python3 -c "
import json, sys
j = json.load(sys.stdin)
assert j['margin'] == 0.25 and j['aspect'] == 2 and j['size'] == 16 and j['levels'] == 5 and j['files'][0]['path'] == 'j.exr', j" ||
  fail "--json"

# a name that is no UTF-8 is printed all the same
"$ltcfit" prefilter picture.png --json -o $'n\xff.dds' | python3 -c "
import json, sys
assert json.load(sys.stdin)['files'][0]['path'] == 'n\ufffd.dds'" || fail "--json of a name that is no UTF-8"

"$ltcfit" export "$source_dir/data/ltc_iso.json" --format exr -q -o m00.exr || fail "no table as EXR"

touch after  # in the list too
ls > before
# expect MESSAGE COMMAND...
expect() {
  local message=$1
  shift
  "$ltcfit" prefilter "$@" >stdout.txt 2>stderr.txt </dev/null
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -q -- "$message" stderr.txt || fail "no '$message' in the message of: $* -- $(cat stderr.txt)"
  rm -f stdout.txt stderr.txt
}
expect "missing.png: cannot read" missing.png -o x.ktx2
expect "cut.png: PNG" cut.png -o x.ktx2
expect "text.png: neither" text.png -o x.ktx2
expect "ends in .exr, .dds or .ktx2" picture.png -o x.png
expect "--output is required" picture.png
expect "no/such" picture.png -o no/such/x.exr
expect "is for .ktx2" picture.png -o x.dds --uncompressed
expect "--margin" picture.png -o x.dds --margin 5
expect "--aspect" picture.png -o x.dds --aspect 0
expect "thin.png: 65 x 1 pixels .* --aspect" thin.png -o x.dds
expect "--size: Value -1 not in range" picture.png -o x.dds --size -1
expect "size 48: need a power of two" picture.png -o x.dds --size 48
expect "--float" picture.png -o x.dds --half --float
expect "a.exr: EXR: a tiled picture; .* --scanline" a.exr -o a2.exr # mip maps are no picture
expect "m00.exr: EXR: need channels R, G and B, or Y alone; it has fresnel, m00, " m00.exr -o x.exr
ls > after
cmp -s before after || fail "files were left: $(diff before after)"
finish
