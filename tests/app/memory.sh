# What takes more memory than there is is refused before the work, with the number; estimates are right.
. "$(dirname "$0")/common.sh" "$@"

if ! (ulimit -v 1500000; "$ltcfit" --version) > /dev/null 2>&1; then
  echo "SKIPPED: this build does not start in 1.5 GB of address space (sanitizers take more)"
  exit 77
fi
"$ltcfit" fit iso -q -o t.json --size 4x4 --preset fast || fail "the fit"
python3 - <<'PY'
import struct, zlib
def chunk(kind, data):
    return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
open('p.png', 'wb').write(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2, 2, 8, 0, 0, 0, 0)) +
                          chunk(b'IDAT', zlib.compress(b'\0\1\2' * 2)) + chunk(b'IEND', b''))
PY

# refused TEXT COMMAND...: in 1.5 GB of address space, at once, without a file
refused() {
  text=$1
  shift
  (ulimit -v 1500000; timeout 20 "$ltcfit" "$@" > out.txt 2> err.txt)
  code=$?
  [ $code -eq 2 ] || fail "$*: exit $code: $(cat err.txt)"
  grep -q "take about [0-9]* bytes ([0-9.e+]* GB) of memory, and [0-9]* bytes" err.txt || fail "$*: $(cat err.txt)"
  grep -q -- "$text" err.txt || fail "$*: not '$text' but $(cat err.txt)"
  [ ! -e new.json ] && [ ! -e new.dds ] && [ ! -e new.json.part ] || fail "$* left a file"
}
refused "--points 4194304: .*: at most [0-9]* fit" refine t.json -o new.json --points 4194304
refused "--refine-points 4194304: .*: at most [0-9]* fit" fit aniso -o new.json --refine --refine-points 4194304
refused "lower --size" fit aniso -o new.json --size 64x64x64x64
refused "lower --samples, --directions or --threads" fit iso -o new.json --fitter sw-sgd --samples 1048576 --directions 65536
refused "lower --samples, --directions or --threads" fit entry --alpha-x 0.5 --fitter sw-sgd --samples 1048576 --directions 65536
refused "lower --samples or --threads" fit iso -o new.json --fitter l3 --samples 1048576 --threads 64 --size 16x16
refused "lower --lights or --threads" fit iso -o new.json --lights 65536 --threads 1024 --size 64x64
refused "lower --count, --samples" score t.json --points off-grid --count 100000000
refused "lower --count, --samples" score t.json --samples 4194304 --directions 65536
refused "lower --size" prefilter p.png -o new.dds --size 4096
if "$ltcfit" report --help > /dev/null 2>&1; then
  refused "lower --points, --samples" report t.json -o new.html --points 1000000 --samples 1048576
fi

# the estimate that a refusal names, and the peak of the same run with room enough, at two sizes each
python3 - "$ltcfit" <<'PY' || fail "estimates"
import os, re, resource, subprocess, sys
ltcfit = sys.argv[1]

def peak(arguments):
    with open(os.devnull, 'w') as null:
        process = subprocess.Popen([ltcfit] + arguments, stdout=null)
        _, status, usage = os.wait4(process.pid, 0)
    assert status == 0, arguments
    return 1024 * usage.ru_maxrss

def estimate(arguments):
    for limit in range(20, 4000, 20):  # the first that the program starts in
        def less():
            resource.setrlimit(resource.RLIMIT_AS, (limit << 20, limit << 20))
        run = subprocess.run([ltcfit] + arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                             text=True, preexec_fn=less)
        found = re.search(r'take about (\d+) bytes', run.stderr)
        if found:
            return int(found.group(1))
        assert run.returncode != 0, arguments
    raise SystemExit('never refused: ' + ' '.join(arguments))

program = peak(['--version'])
for arguments in (
        'refine t.json -q -o r.json --iterations 1 --fresh 0 --threads 1 --points 700',
        'refine t.json -q -o r.json --iterations 1 --fresh 0 --threads 1 --points 2000',
        'fit iso -q -o f.json --size 2x2 --alpha-floor 0.5 --fitter l3 --max-evaluations 5 --threads 1 --samples 524288 --score-points 0',
        'fit iso -q -o f.json --size 2x2 --alpha-floor 0.5 --fitter l3 --max-evaluations 5 --threads 2 --samples 1048576 --score-points 0',
        'score t.json -q --threads 1 --count 1 --samples 262144',
        'score t.json -q --threads 2 --count 2 --samples 65536 --directions 128'):
    arguments = arguments.split()
    told = estimate(arguments)
    took = peak(arguments) - program
    print(f'{told / took:.2f} of {took} bytes: {" ".join(arguments)}')
    assert took > 20e6 and 1 / 1.5 < told / took < 1.5, arguments
PY
finish
