# Killed at any moment, the program leaves the old file, the new one or none: never a part of one.
. "$(dirname "$0")/common.sh" "$@"

fit() { "$ltcfit" fit iso -q -o "$1" --size 24x24 --report "$1.csv"; }
start=$(date +%s%N)
fit whole.json || fail "the fit itself"
ms=$((($(date +%s%N) - start) / 1000000))
mkdir run
kills=0
echo "one run takes $ms ms"
# moments all over the run, drawn before it starts
for delay in $(python3 -c "import random; random.seed(1); [print(random.random() * 1.05 * $ms / 1000) for _ in range(20)]"); do
  (exec "$ltcfit" fit iso -q -o run/t.json --size 24x24 --report run/t.json.csv) &
  pid=$!
  sleep "$delay"
  if kill -9 $pid 2>/dev/null; then kills=$((kills + 1)); fi
  wait $pid 2>/dev/null
  for f in run/*; do
    [ -e "$f" ] || continue
    case $f in
      *.part) ;;  # finished entries: see resume.sh
      *.csv*) cmp -s "$f" whole.json.csv || fail "a part of $f after kill $kills" ;;
      *) cmp -s "$f" whole.json || fail "a part of $f after kill $kills" ;;
    esac
  done
  rm -f run/*
done
[ $kills -ge 8 ] || fail "only $kills runs were alive to be killed"
# an old file survives a killed run that was to replace it
echo old > run/t.json
(exec "$ltcfit" fit iso -q -o run/t.json --size 24x24) &
pid=$!
sleep 0.02
kill -9 $pid 2>/dev/null && wait $pid 2>/dev/null
if [ "$(cat run/t.json)" != old ]; then cmp -s run/t.json whole.json || fail "the old file was spoilt"; fi
finish
