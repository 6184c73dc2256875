# The same bytes for any number of threads, and for every run.
. "$(dirname "$0")/common.sh" "$@"

for threads in 1 2 5; do
  "$ltcfit" fit iso -q -o t$threads.json --size 16x16 --threads $threads --report t$threads.csv || fail "threads $threads"
  cmp -s t1.json t$threads.json || fail "$threads threads give another table"
  cmp -s t1.csv t$threads.csv || fail "$threads threads give another report"
done
for threads in 1 2; do
  "$ltcfit" fit aniso -q -o a$threads.json --size 3x4x3x3 --threads $threads || fail "aniso, threads $threads"
  "$ltcfit" fit aniso -q -o s$threads.json --size 2x2x2x2 --fitter sw-sgd --threads $threads || fail "sw-sgd, threads $threads"
  "$ltcfit" fit aniso -q -o w$threads.json --size 3x3x3x3 --fitter sw --threads $threads || fail "sw, threads $threads"
  "$ltcfit" fit iso -q -o l$threads.json --size 8x8 --fitter l3 --threads $threads || fail "l3, threads $threads"
done
cmp -s a1.json a2.json && cmp -s s1.json s2.json && cmp -s w1.json w2.json && cmp -s l1.json l2.json || fail "2 threads give another table"
"$ltcfit" fit iso -q -o again.json --size 16x16 && cmp -s t1.json again.json || fail "a second run gives another table"
"$ltcfit" fit iso -q -o seed.json --size 16x16 --seed 2 && ! cmp -s t1.json seed.json || fail "the seed changes nothing"
"$ltcfit" score -q t1.json --points off-grid --count 20 --threads 1 > s1.txt
"$ltcfit" score -q t1.json --points off-grid --count 20 --threads 2 > s2.txt
cmp -s s1.txt s2.txt || fail "the score depends on the threads"
# the file says how to make it again, and that command does
command=$(python3 -c "import json; print(json.load(open('t1.json'))['provenance']['command'])")
$ltcfit ${command#ltcfit } -q -o made.json && cmp -s t1.json made.json || fail "'$command' makes another table"
command=$(python3 -c "import json; print(json.load(open('a1.json'))['provenance']['command'])")
$ltcfit ${command#ltcfit } -q -o made.json && cmp -s a1.json made.json || fail "'$command' makes another table"
# JSON in, the same JSON out
"$ltcfit" export -q t1.json --format json -o copy.json && cmp -s t1.json copy.json || fail "export --format json changes the table"
"$ltcfit" score -q t1.json --json --count 5 | python3 -c "import json, sys; json.load(sys.stdin)" || fail "score --json"
"$ltcfit" fit iso --json --size 3x3 --score-points 4 -o j.json | python3 -c "import json, sys; json.load(sys.stdin)" || fail "fit --json"
finish
