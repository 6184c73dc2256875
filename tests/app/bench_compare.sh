# scripts/bench_compare.py on results whose answer is known, on bad input, and on what the benchmark program writes.
. "$(dirname "$0")/common.sh" "$@"
bench() { python3 "$source_dir/scripts/bench_compare.py" "$@" >out.txt 2>message.txt; }

# Nine repetitions that spread by 2 % (interquartile range) about a median: uncertainty of a ratio 4 %.
python3 - <<'PY'
import copy, json
def times(median, spread=0.02):
    return [median * (1 + spread * (i - 4) / 4) for i in (3, 8, 0, 5, 2, 7, 4, 1, 6)]
base = {"format": "ltcfit-bench", "version": 1,
        "context": {"cpu": "some", "cores": 2, "compiler": "GCC 12.2.0", "build": "Release"},
        "benchmarks": {"calibration": {"time_ns": times(3000.0), "errors": {}},
                       "kernel": {"time_ns": times(50.0), "errors": {"relative_error": 1e-3}},
                       "fit": {"time_ns": times(2e9), "errors": {"SW1": 0.02, "light_m": 0.004}}}}
def write(name, change=lambda r, b: None):
    r = copy.deepcopy(base)
    change(r, r["benchmarks"])
    json.dump(r, open(name + ".json", "w"))
def scale(entry, factor): entry["time_ns"] = [t * factor for t in entry["time_ns"]]
def all_slower(r, b):
    for entry in b.values(): scale(entry, 2.0)
def calibration_faster(r, b): scale(b["calibration"], 0.5)
def erase(r, b): del b["fit"], b["kernel"]["errors"]["relative_error"]
def add(r, b): b["other"] = copy.deepcopy(b["kernel"])
def set_error(value): return lambda r, b: b["fit"]["errors"].__setitem__("SW1", value)
def set_time(i, value): return lambda r, b: b["kernel"]["time_ns"].__setitem__(i, value)
write("base")
write("slower", lambda r, b: scale(b["kernel"], 1.5))
write("little", lambda r, b: scale(b["kernel"], 1.12))
write("faster", lambda r, b: scale(b["kernel"], 0.5))
write("all_slower", all_slower)
write("calibration_faster", calibration_faster)
# spread wide, 1.5 times slower: interquartile range 80 %
write("noisy", lambda r, b: b["kernel"].update(time_ns=times(75.0, 0.8)))
write("noisy_base", lambda r, b: b["kernel"].update(time_ns=times(50.0, 0.8)))
write("error5", set_error(0.021))
write("error1", set_error(0.0202))
write("error_less", set_error(0.01))
write("error_nan", set_error(float("nan")))
write("error_negative", set_error(-0.02))
write("error_text", set_error("0.02"))
write("erased", erase)
write("added", add)
write("rounding", lambda r, b: b["kernel"]["errors"].update(relative_error=1e-13))
write("exact", lambda r, b: b["kernel"]["errors"].update(relative_error=0.0))
write("zero_time", set_time(2, 0.0))
write("nan_time", set_time(2, float("nan")))
write("text_time", set_time(2, "50"))
write("huge_time", set_time(2, 10**400))
write("two_times", lambda r, b: b["kernel"].update(time_ns=[50.0, 51.0]))
write("no_calibration", lambda r, b: b.pop("calibration"))
write("version", lambda r, b: r.update(version=2))
write("other_machine", lambda r, b: r["context"].update(cpu="other"))
text = open("base.json").read()
open("truncated.json", "w").write(text[:len(text) // 2])
open("empty.json", "w").close()
open("binary.json", "wb").write(bytes(range(128, 256)))
open("deep.json", "w").write("[" * 100000)
json.dump({"axes": []}, open("foreign.json", "w"))
json.dump([1, 2], open("list.json", "w"))
PY

# expect CODE PATTERN ARGUMENTS...: what compare says to standard output
expect() {
  local code=$1 pattern=$2
  shift 2
  bench "$@"
  local rc=$?
  [ $rc -eq "$code" ] || fail "exit $rc, not $code: $* -- $(cat message.txt)"
  grep -qE -- "$pattern" out.txt || fail "no '$pattern' in: $* -- $(cat out.txt)"
}
expect 0 "^nothing flagged" compare base.json base.json
expect 3 "^flagged: kernel: 1.50 times" compare base.json slower.json
[ "$(grep -c '^flagged' out.txt)" -eq 1 ] || fail "only the kernel is slower"
expect 0 "^nothing flagged" compare base.json little.json
expect 3 "^flagged: kernel: 1.12 times" compare base.json little.json --limit 1.1
expect 0 "^kernel .* 0.50 .*faster" compare base.json faster.json
expect 0 "^nothing flagged" compare base.json all_slower.json
# a calibration that is off by itself makes everything look slow: all flagged, the fit too
expect 3 "^flagged: fit: 2.00 times" compare base.json calibration_faster.json
expect 0 "^kernel .* 1.50 +0.80" compare base.json noisy.json
expect 0 "^nothing flagged" compare noisy_base.json slower.json
expect 3 "^flagged: fit: SW1 0.021, was 0.02" compare base.json error5.json
[ "$(grep -c '^flagged' out.txt)" -eq 1 ] || fail "only SW1 is worse"
expect 0 "^nothing flagged" compare base.json error5.json --error-limit 1.06
expect 0 "^nothing flagged" compare base.json error1.json
expect 0 "^nothing flagged" compare base.json error_less.json
expect 3 "^flagged: fit: SW1 nan" compare base.json error_nan.json
expect 0 "^nothing flagged" compare exact.json rounding.json
expect 3 "^flagged: kernel: relative_error 0.001, was 0" compare exact.json base.json
expect 0 "^vanished: fit, kernel relative_error$" compare base.json erased.json
expect 0 "^new: fit, kernel relative_error$" compare erased.json base.json
expect 0 "^new: other$" compare base.json added.json
expect 0 "^nothing flagged" compare base.json erased.json --subset
grep -q '^vanished' out.txt && fail "--subset lists what vanished"
expect 0 "^another machine" compare base.json other_machine.json
expect 0 "^fit +2 s  +2.0 %" show base.json
expect 0 "exit code|Exit code" --help

# refuse MESSAGE ARGUMENTS...: exit 2, one line that says why
refuse() {
  local message=$1
  shift
  bench "$@"
  local rc=$?
  [ $rc -eq 2 ] || fail "exit $rc, not 2: $*"
  grep -q -- "$message" message.txt || fail "no '$message' in the message of: $* -- $(cat message.txt)"
}
one_line() {
  refuse "$@"
  [ "$(wc -l < message.txt)" -eq 1 ] || fail "not one line: ${*:2} -- $(cat message.txt)"
  [ ! -s out.txt ] || fail "output in spite of bad input: ${*:2}"
}
for f in truncated empty binary deep; do one_line "$f.json: not JSON" compare base.json $f.json; done
one_line "truncated.json: not JSON" compare truncated.json base.json
one_line "truncated.json: not JSON" show truncated.json
one_line "none.json: No such file" compare base.json none.json
for f in foreign list; do one_line "$f.json: not a benchmark result" compare base.json $f.json; done
one_line "version 2" compare base.json version.json
for f in zero nan text huge; do one_line "kernel: a time is not a number" compare base.json ${f}_time.json; done
one_line "3 times or more" compare base.json two_times.json
one_line "no benchmark 'calibration'" compare no_calibration.json base.json
for f in negative text; do one_line "'errors' must be" compare base.json error_$f.json; done
one_line "an error that is not finite" compare error_nan.json base.json
one_line "not Google Benchmark" condense base.json made.json
one_line "not Google Benchmark" condense list.json made.json
one_line "truncated.json: not JSON" condense truncated.json made.json
refuse "must be 1 or more" compare base.json base.json --limit 0.9
refuse "must be 1 or more" compare base.json base.json --limit nan
[ ! -e made.json ] || fail "condense wrote a file in spite of bad input"

# What the program writes, condensed: comparable, and nothing in it of this machine but its kind.
program=$(dirname "$ltcfit")/tests/ltcfit_bench
if [ -x "$program" ]; then
  "$program" --benchmark_filter='^calibration$|lobeOverQuad|fetch' --benchmark_repetitions=3 --benchmark_min_time=0.001 \
    --benchmark_enable_random_interleaving=true --benchmark_out=raw.json >/dev/null 2>&1 || fail "ltcfit_bench"
  bench condense raw.json result.json || fail "condense: $(cat message.txt)"
  expect 0 "^nothing flagged" compare result.json result.json
  expect 0 "^lobeOverQuad " show result.json
  expect 0 "^  worst_error " show result.json
  expect 0 "^new: kernel, fit$" compare result.json base.json --subset --limit 1e9
  for key in host_name executable date load_avg "$(hostname)" "$program"; do
    grep -qF -- "\"$key" result.json && fail "the result tells $key"
  done
  python3 - <<'PY' || fail "condensed figures"
import json, sys
raw, result = json.load(open("raw.json")), json.load(open("result.json"))["benchmarks"]
runs = [r for r in raw["benchmarks"] if r["run_type"] == "iteration"]
assert len(result) == 4 and len(runs) == 12
for r in runs:
    ns = r["cpu_time"] * {"ns": 1, "us": 1e3}[r["time_unit"]]
    assert any(abs(t / ns - 1) < 1e-4 for t in result[r["run_name"]]["time_ns"]), r
    if r["name"].startswith("lobeOverQuad"):
        assert abs(result["lobeOverQuad"]["errors"]["worst_error"] / r["worst_error"] - 1) < 1e-5
# errors that differ between repetitions
next(r for r in runs if r["run_name"] == "lobeOverQuad")["worst_error"] *= 1.1
json.dump(raw, open("differ.json", "w"))
next(r for r in runs if r["run_name"] == "calibration").update(error_occurred=True, error_message="broken")
json.dump(raw, open("failed.json", "w"))
PY
  one_line "lobeOverQuad: errors differ" condense differ.json made.json
  one_line "calibration failed: broken" condense failed.json made.json
  bench condense raw.json none/made.json
  [ $? -eq 1 ] || fail "a folder that is not there: exit 1"
fi

# scripts/bench.sh refuses before it builds or runs anything.
refuse_run() {
  bash "$source_dir/scripts/bench.sh" "${@:2}" >out.txt 2>message.txt
  [ $? -eq 2 ] || fail "bench.sh ${*:2}: not refused"
  grep -q -- "$1" message.txt || fail "no '$1' in the message of bench.sh ${*:2} -- $(cat message.txt)"
}
refuse_run "unknown option --bogus" --bogus
refuse_run "must be 3..9999" --repetitions 2
refuse_run "must be 3..9999" --repetitions many
refuse_run "needs a value" --filter
refuse_run "no such file" --against none.json
refuse_run "not --filter" --renew --filter fit
bash "$source_dir/scripts/bench.sh" --help | grep -q -- --renew || fail "bench.sh --help"
bench show "$source_dir/data/bench/baseline.json" || fail "data/bench/baseline.json: $(cat message.txt)"
finish
