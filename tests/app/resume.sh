# A run that was killed, at any moment and more than once, goes on with --resume and ends with the same bytes.
. "$(dirname "$0")/common.sh" "$@"

fit() { "$ltcfit" fit aniso -q -o "$1" --size 5x5x4x4 --report "$1.csv" "${@:2}"; }
start=$(date +%s%N)
fit whole.json || fail "the fit itself"
ms=$((($(date +%s%N) - start) / 1000000))
[ ! -e whole.json.part ] || fail "a finished run left its checkpoint"
echo "one run takes $ms ms"
kills=0
resumed=0
for delay in $(python3 -c "import random; random.seed(2); [print(random.random() * 0.95 * $ms / 1000) for _ in range(12)]"); do
  rm -f t.json*
  (exec "$ltcfit" fit aniso -q -o t.json --size 5x5x4x4 --report t.json.csv) & pid=$!
  sleep "$delay"
  kill -9 $pid 2>/dev/null && kills=$((kills + 1))
  wait $pid 2>/dev/null
  [ -e t.json ] && continue
  # a second kill, sooner, then a last line that was cut off, then to the end
  (exec "$ltcfit" fit aniso -q -o t.json --size 5x5x4x4 --report t.json.csv --resume) & pid=$!
  sleep "$(python3 -c "print($delay / 3)")"
  kill -9 $pid 2>/dev/null
  wait $pid 2>/dev/null
  if [ -e t.json.part ]; then
    size=$(stat -c %s t.json.part)
    [ "$size" -gt 2000 ] && resumed=$((resumed + 1)) && truncate -s $((size - 7)) t.json.part
  fi
  fit t.json --resume || fail "--resume"
  cmp -s t.json whole.json || fail "another table after a kill at $delay s"
  cmp -s t.json.csv whole.json.csv || fail "another report after a kill at $delay s"
  [ ! -e t.json.part ] || fail "the checkpoint was left"
done
[ $kills -ge 10 ] || fail "only $kills runs were alive to be killed"
[ $resumed -ge 5 ] || fail "only $resumed runs had something to resume"
# without --resume an interrupted run's work is not thrown away
timeout -s KILL "$(python3 -c "print(0.6 * $ms / 1000)")" "$ltcfit" fit aniso -q -o t2.json --size 5x5x4x4 2>/dev/null
[ -s t2.json.part ] || fail "no checkpoint after a kill"
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
