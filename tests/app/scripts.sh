# The scripts of a newcomer in a project whose programs only note how they are called: what is installed, configured,
# built and made, and what happens where a package, a network or the charting library is missing.
. "$(dirname "$0")/common.sh" "$@"
export CALLS=$work/calls
unset LTCFIT_PRESET  # the run of the tests may have one of its own
mkdir -p bin project/scripts project/build/report/charts
cp "$source_dir"/scripts/{setup,fit,measure}.sh project/scripts
touch project/CMakePresets.json
printf '# a list\nlibone # needed\ntool sh # sh is always there\n' > project/scripts/packages.txt
printf 'libtwo # only for the tests\n' > project/scripts/packages-test.txt
shim() { printf '#!/bin/bash\necho "${0##*/} $*" >> "$CALLS"\n%s\n' "$2" > "$1"; chmod +x "$1"; }
shim bin/dpkg-query 'if grep -qx "${!#}" "$INSTALLED"; then echo "install ok installed"; else exit 1; fi'
shim bin/dpkg ''
shim bin/id 'echo 0'
shim bin/cmake 'case $1 in --preset) touch build/build.ninja ;; --build) printf "[1/100] one\n[100/100] two\na warning\n" ;; esac'
shim bin/apt-get 'if [ "$1" = install ]; then shift 4; printf "%s\n" "$@" >> "$INSTALLED"; fi'
# every -o is written, and `check-gl -o` is a folder
shim project/build/ltcfit 'for argument; do if [ "${previous:-}" = -o ]; then case $argument in
    out/shading*) mkdir -p $argument ;; *) echo x > $argument ;; esac; fi; previous=$argument; done
  [ "$1" != "${FAILS:-}" ] || exit 1'
export PATH=$work/bin:$PATH INSTALLED=$work/installed
run() { # COMMAND...
  : > "$CALLS"
  (cd project && "$@") > out.txt 2>&1 < /dev/null
}
called() { grep -q "$1" "$CALLS" || fail "no call of '$1' among: $(cat "$CALLS") -- $(cat out.txt)"; }
not_called() { ! grep -q "$1" "$CALLS" || fail "a call of '$1' among: $(cat "$CALLS") -- $(cat out.txt)"; }
says() { grep -q "$1" out.txt || fail "does not say '$1': $(cat out.txt)"; }

# the program alone; what the tests need comes with --tests
: > installed
run scripts/setup.sh || fail "setup.sh: $(cat out.txt)"
called "apt-get install .* libone$"
called "cmake --preset release"
called "cmake --build build --target ltcfit"
says "installing.*libone"
says "^\[100/100\] two"
! grep -q "^\[1/100\]" out.txt || fail "every line of the build is shown: $(cat out.txt)"
says "^a warning"
run scripts/setup.sh --tests || fail "setup.sh --tests: $(cat out.txt)"
called "apt-get install .* libtwo$"
called "cmake --build build --target all"
# warm: nothing but the build is asked. Killed between installation and configuration: configured
touch -d '1 minute' project/build/build.ninja
run scripts/setup.sh --tests || fail "a warm setup.sh: $(cat out.txt)"
not_called "apt-get"
not_called "cmake --preset"
if [ -e /var/lib/dpkg/status ]; then
  touch -d '1970-01-02' project/build/build.ninja project/CMakePresets.json
  run scripts/setup.sh || fail "setup.sh after an installation: $(cat out.txt)"
  called "cmake --preset"
fi
run scripts/setup.sh --nonsense && fail "setup.sh takes --nonsense"
# no network: named, and gone on with; a build that fails ends it
: > installed
shim bin/apt-get 'echo "E: unable to fetch" >&2; exit 100'
run scripts/setup.sh || fail "setup.sh without a network: $(cat out.txt)"
says "unable to fetch"
says "NOT INSTALLED: libone"
called "cmake --build"
echo libone > installed
run scripts/setup.sh || fail "setup.sh without a network, all installed: $(cat out.txt)"
not_called "apt-get"
shim bin/cmake 'exit 1'
run scripts/setup.sh && fail "setup.sh hides that the build failed"
rm project/build/build.ninja
shim bin/cmake "echo \"--   Package 'libone' not found\"; exit 1"
run scripts/setup.sh && fail "setup.sh hides that the configuration failed"
says "Package 'libone' not found"

# the tables and the page; then what takes minutes
shim project/scripts/setup.sh ''
run scripts/fit.sh || fail "fit.sh: $(cat out.txt)"
for file in ltc_iso.json ltc_iso.h ltc_iso.ktx2 ltc_iso.json ltc_aniso.h ltc_aniso.ktx2 report.html; do
  [ -s project/out/$file ] || fail "fit.sh has not made $file"
done
not_called "ltcfit \(pareto\|stability\|check-gl\)"
run scripts/measure.sh || fail "measure.sh: $(cat out.txt)"
called "ltcfit report .*--pareto out/pareto_iso.json .*--shading out/shading_aniso/shading.json --stability out/stability.json"
FAILS=check-gl run scripts/measure.sh || fail "measure.sh without OpenGL: $(cat out.txt)"
tail -1 out.txt | grep -q "^left out: shading" || fail "measure.sh does not end with what is left out: $(cat out.txt)"
not_called "report.*--shading"
FAILS=pareto run scripts/measure.sh && fail "measure.sh hides a failure"
# without the charting library: said at the start and at the end, everything else made, no old page kept
echo "npm could not fetch it: ECONNREFUSED" > project/build/report/charts/missing.txt
run scripts/fit.sh || fail "fit.sh without charts: $(cat out.txt)"
for at in head tail; do $at -1 out.txt | grep -q "^left out: the page.*ECONNREFUSED" || fail "fit.sh, $at: $(cat out.txt)"; done
called "ltcfit fit aniso"
not_called "ltcfit report"
[ ! -e project/out/report.html ] || fail "an old page beside new tables"
run scripts/measure.sh || fail "measure.sh without charts: $(cat out.txt)"
says "^left out: the page.*ECONNREFUSED"
called "ltcfit stability"
not_called "ltcfit report"
run scripts/fit.sh --tables-only || fail "fit.sh --tables-only: $(cat out.txt)"
! grep -q "left out" out.txt || fail "--tables-only has no page to leave out: $(cat out.txt)"
finish
