# A run that was killed, at any moment and more than once, goes on with --resume and ends with the same bytes.
. "$(dirname "$0")/common.sh" "$@"

fit() { "$ltcfit" fit aniso -q -o "$1" --size 5x5x4x4 --report "$1.csv" "${@:2}"; }
fit whole.json || fail "the fit itself"
lobes=$(($(wc -l < whole.json.csv) - 1))
[ ! -e whole.json.part ] || fail "a finished run left its checkpoint"

# run_until LINES OPTIONS...: starts a fit of t.json, kills it when its checkpoint has so many lines
killed=0
run_until() {
  local lines=$1
  shift
  (exec "$ltcfit" fit aniso -q -o t.json --size 5x5x4x4 --report t.json.csv "$@") & local pid=$!
  while kill -0 $pid 2>/dev/null && [ "$(wc -l 2>/dev/null < t.json.part || echo 0)" -lt "$lines" ]; do sleep 0.005; done
  kill -9 $pid 2>/dev/null && killed=$((killed + 1))
  wait $pid 2>/dev/null
}
resumed=0
for lines in $(python3 -c "import random; random.seed(2); [print(random.randint(1, int(0.9 * $lobes))) for _ in range(12)]"); do
  rm -f t.json*
  run_until "$lines"
  [ -e t.json ] && continue
  # a second kill, later, then a last line that was cut off, then to the end
  run_until $((lines + lobes / 20)) --resume
  if [ -e t.json.part ]; then
    size=$(stat -c %s t.json.part)
    [ "$size" -gt 2000 ] && resumed=$((resumed + 1)) && truncate -s $((size - 7)) t.json.part
  fi
  fit t.json --resume || fail "--resume"
  cmp -s t.json whole.json || fail "another table after a kill at $lines of $lobes lobes"
  cmp -s t.json.csv whole.json.csv || fail "another report after a kill at $lines of $lobes lobes"
  [ ! -e t.json.part ] || fail "the checkpoint was left"
done
[ $killed -ge 16 ] || fail "only $killed runs were alive to be killed"
[ $resumed -ge 8 ] || fail "only $resumed runs had something to resume"
# without --resume an interrupted run's work is not thrown away
rm -f t.json*
run_until $((lobes / 2))
mv t.json.part t2.json.part || fail "no checkpoint after a kill"
fit t2.json 2>message.txt; [ $? -eq 2 ] && grep -q -- --resume message.txt || fail "an interrupted run was overwritten"
"$ltcfit" fit aniso -q -o t2.json --size 5x5x4x4 --seed 2 --resume 2>message.txt
[ $? -eq 2 ] && grep -q "holds another run" message.txt || fail "another run's checkpoint was taken"
# a damaged line is a job that is fitted again
python3 - <<'PY'
import re
lines = open('t2.json.part').read().split('\n')
assert len(lines) > 4
lines[2] = re.sub(r'\d', '7', lines[2], count=30)
open('t2.json.part', 'w').write('\n'.join(lines))
PY
fit t2.json --resume && cmp -s t2.json whole.json || fail "a damaged line was believed"
finish
