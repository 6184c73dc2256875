# What is said on stderr cannot end a run, wherever it goes; what is printed on stdout and does not arrive is a
# failure, but costs no file.
. "$(dirname "$0")/common.sh" "$@"

cat > gone.py <<'PY'
"""gone.py WHAT COMMAND...: runs a command whose stderr is a terminal that goes away when the first progress is seen
on it (terminal), or whose stderr or stdout is a pipe that nobody reads (stderr, stdout). Ends with its exit code."""
import os, pty, subprocess, sys
what, command = sys.argv[1], sys.argv[2:]
read, write = pty.openpty() if what == "terminal" else os.pipe()
streams = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": None}
streams["stdout" if what == "stdout" else "stderr"] = write
if what != "terminal":
    os.close(read)
run = subprocess.Popen(command, start_new_session=True, **streams)
os.close(write)
if what == "terminal":
    seen = os.read(read, 100)
    os.close(read)
    if b" of " not in seen:
        sys.exit(f"no progress line: {seen}")
code = run.wait(timeout=300)
sys.exit(code if code >= 0 else 128 - code)
PY
light=(fit iso --size 12x12 --score-points 0)
l3=(fit iso --fitter l3 --size 7x7 --score-points 0)
"$ltcfit" "${light[@]}" -q -o light.json && "$ltcfit" "${l3[@]}" -q -o l3.json || fail "the fits themselves"
score=(score light.json --points off-grid --count 30)
"$ltcfit" "${score[@]}" > score.txt || fail "the score itself"

# same NAME HOW: the table is there and the same
same() { cmp -s "$1.json" made.json || fail "$1, $2: no table, or another one"; rm -f made.json*; }
python3 gone.py terminal "$ltcfit" "${light[@]}" -o made.json || fail "light, the terminal gone"; same light "terminal gone"
python3 gone.py terminal "$ltcfit" "${l3[@]}" -o made.json || fail "l3, the terminal gone"; same l3 "terminal gone"
python3 gone.py terminal "$ltcfit" "${score[@]}" --report made.csv || fail "score, the terminal gone"
[ -s made.csv ] || fail "score, the terminal gone: no report"
for fit in light l3; do
  declare -n arguments=$fit
  "$ltcfit" "${arguments[@]}" -o made.json >/dev/null 2>&- || fail "$fit, stderr closed"; same $fit "stderr closed"
  "$ltcfit" "${arguments[@]}" -o made.json >/dev/null 2>/dev/full || fail "$fit, stderr full"; same $fit "stderr full"
done
"$ltcfit" "${score[@]}" 2>&- | cmp -s - score.txt || fail "score, stderr closed"
"$ltcfit" "${score[@]}" 2>/dev/full | cmp -s - score.txt || fail "score, stderr full"

# a warning is lost, the file is not
"$ltcfit" fit iso -q -o sharp.json --size 4x4 --lights 32 || fail "the fit of a sharp table"
"$ltcfit" export sharp.json -o half.dds --precision half >/dev/null 2>warnings.txt || fail "export of halves"
grep -q "warning: half precision" warnings.txt || fail "no warning about halves: $(cat warnings.txt)"
mv half.dds whole.dds
for how in closed full gone; do
  case $how in
    closed) "$ltcfit" export sharp.json -o half.dds --precision half >/dev/null 2>&- ;;
    full) "$ltcfit" export sharp.json -o half.dds --precision half >/dev/null 2>/dev/full ;;
    gone) python3 gone.py stderr "$ltcfit" export sharp.json -o half.dds --precision half ;;
  esac || fail "export, stderr $how: exit $?"
  cmp -s half.dds whole.dds || fail "export, stderr $how: another file"
  rm -f half.dds
done
# an exit code says what it says without a message
"$ltcfit" "${light[@]}" -q --seed 2 -o other.json || fail "the fit of another seed"
compare=(compare light.json other.json --tolerance 0)
"$ltcfit" "${compare[@]}" >/dev/null 2>&1; [ $? -eq 3 ] || fail "compare of different tables"
"$ltcfit" "${compare[@]}" >/dev/null 2>&-; [ $? -eq 3 ] || fail "compare, stderr closed"
"$ltcfit" "${compare[@]}" >/dev/null 2>/dev/full; [ $? -eq 3 ] || fail "compare, stderr full"
python3 gone.py stderr "$ltcfit" "${compare[@]}"; [ $? -eq 3 ] || fail "compare, stderr's reader gone"
"$ltcfit" score missing.json 2>/dev/full; [ $? -eq 2 ] || fail "missing file, stderr full"

# a closed descriptor is not another file's: what is meant for stderr would go there
"$ltcfit" fit iso --size 40x40 --score-points 0 -q -o long.json 2>&- &
run=$!
for _ in $(seq 500); do [ -e long.json.part ] && break; sleep 0.01; done
[ "$(readlink /proc/$run/fd/2)" = /dev/null ] || fail "stderr closed: descriptor 2 is $(readlink /proc/$run/fd/2)"
kill $run; wait $run 2>/dev/null; rm -f long.json*

# stdout: exit 1 and a message, and the files are written
expect_failure() { # HOW CODE
  [ "$2" -eq 1 ] || fail "$1: exit $2, not 1"
  grep -q "standard output" message.txt || fail "$1: no message: $(cat message.txt)"
}
"$ltcfit" "${score[@]}" >/dev/full 2>message.txt; expect_failure "score, stdout full" $?
"$ltcfit" "${score[@]}" --json >/dev/full 2>message.txt; expect_failure "score --json, stdout full" $?
"$ltcfit" "${score[@]}" >&- 2>message.txt; expect_failure "score, stdout closed" $?
"$ltcfit" "${light[@]}" -o made.json >/dev/full 2>message.txt; expect_failure "fit, stdout full" $?
same light "stdout full"
"$ltcfit" "${light[@]}" -o made.json >&- 2>&-; [ $? -eq 1 ] || fail "fit, both closed: exit $?"
same light "both closed"
for redirection in full closed; do
  rm -rf folder; mkdir folder
  if [ $redirection = full ]; then
    "$ltcfit" export light.json --resample --profile selfshadow-dds -o folder >/dev/full 2>message.txt
  else
    "$ltcfit" export light.json --resample --profile selfshadow-dds -o folder >&- 2>message.txt
  fi
  expect_failure "export, stdout $redirection" $?
  [ "$(ls folder | wc -l)" -ge 2 ] || fail "export, stdout $redirection: only $(ls folder)"
done
# a reader that has seen enough
python3 gone.py stdout "$ltcfit" "${score[@]}" 2>message.txt; expect_failure "score, stdout's reader gone" $?
finish
