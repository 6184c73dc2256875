# The same bytes for any number of threads, and for every run.
. "$(dirname "$0")/common.sh" "$@"

for threads in 1 2 5; do
  "$ltcfit" fit iso -q -o t$threads.json --size 16x16 --threads $threads --report t$threads.csv || fail "threads $threads"
  cmp -s t1.json t$threads.json || fail "$threads threads give another table"
  cmp -s t1.csv t$threads.csv || fail "$threads threads give another report"
done
"$ltcfit" fit iso -q -o again.json --size 16x16 && cmp -s t1.json again.json || fail "a second run gives another table"
"$ltcfit" fit iso -q -o seed.json --size 16x16 --seed 2 && ! cmp -s t1.json seed.json || fail "the seed changes nothing"
"$ltcfit" score -q t1.json --points off-grid --count 20 --threads 1 > s1.txt
"$ltcfit" score -q t1.json --points off-grid --count 20 --threads 2 > s2.txt
cmp -s s1.txt s2.txt || fail "the score depends on the threads"
# the file says how to make it again, and that command does
command=$(python3 -c "import json; print(json.load(open('t1.json'))['provenance']['command'])")
$ltcfit ${command#ltcfit } -q -o made.json && cmp -s t1.json made.json || fail "'$command' makes another table"
# JSON in, the same JSON out
"$ltcfit" export -q t1.json --format json -o copy.json && cmp -s t1.json copy.json || fail "export --format json changes the table"
"$ltcfit" score -q t1.json --json --count 5 | python3 -c "import json, sys; json.load(sys.stdin)" || fail "score --json"
"$ltcfit" fit iso --json --size 3x3 --score-points 4 -o j.json | python3 -c "import json, sys; json.load(sys.stdin)" || fail "fit --json"
finish
