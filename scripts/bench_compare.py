#!/usr/bin/env python3
"""Results of the benchmarks: condense what Google Benchmark wrote, show a result, compare two.

  bench_compare.py condense RAW.json RESULT.json
  bench_compare.py show RESULT.json
  bench_compare.py compare BASELINE.json RESULT.json [--limit X] [--error-limit X] [--subset]

Machines differ, and one machine differs from minute to minute. So every run holds a calibration kernel, arithmetic
that no change of the project touches, and what is compared is
  ratio = (time / calibration of the result) / (time / calibration of the baseline),
each the median of the run's repetitions, in CPU time. Its uncertainty "+-" is the interquartile ranges of the four,
relative to their medians, added in quadrature: about three standard errors for nine repetitions. A benchmark is
flagged as SLOWER where ratio > limit and ratio > 1 + uncertainty, and marked as faster where the same holds for
1 / ratio. Errors are compared as they are, since equal builds give equal errors: one that rises above error-limit
times the baseline's, or is not finite, is flagged as WORSE.

Benchmarks that only one file has are listed, not flagged. Exit code: 0 nothing flagged, 1 a file that cannot be
written, 2 bad option or input, 3 flagged.
"""

import argparse
import json
import math
import os
import statistics
import sys
import tempfile

FORMAT = "ltcfit-bench"
VERSION = 1
CALIBRATION = "calibration"
NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
FEWEST = 3  # repetitions that have a spread
ROUNDING = 1e-12  # errors below are rounding, and may come out anyhow

# Everything in Google Benchmark's entry of a repetition that is not a counter.
NO_COUNTERS = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions",
               "repetition_index", "threads", "iterations", "real_time", "cpu_time", "time_unit", "label",
               "error_occurred", "error_message"}


class BadInput(Exception):
    """What the message says; exit code 2."""


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from error
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{path}: not JSON, or cut off: {error}") from error


def is_number(value):
    return isinstance(value, float) or (type(value) is int and abs(value) < 2**63)


def read_result(path):
    """A result file, checked: {name: {"time_ns": [...], "errors": {...}}} and its context."""
    root = read_json(path)
    if not isinstance(root, dict) or root.get("format") != FORMAT:
        raise BadInput(f"{path}: not a benchmark result ('format' is not '{FORMAT}')")
    if root.get("version") != VERSION:
        raise BadInput(f"{path}: version {root.get('version')}, this script reads {VERSION}")
    context, benchmarks = root.get("context"), root.get("benchmarks")
    if not isinstance(context, dict) or not isinstance(benchmarks, dict):
        raise BadInput(f"{path}: 'context' and 'benchmarks' must be objects")
    for name, entry in benchmarks.items():
        times = entry.get("time_ns") if isinstance(entry, dict) else None
        if not isinstance(times, list) or len(times) < FEWEST:
            raise BadInput(f"{path}: {name}: 'time_ns' must be a list of {FEWEST} times or more")
        if not all(is_number(t) and math.isfinite(t) and t > 0 for t in times):
            raise BadInput(f"{path}: {name}: a time is not a number above 0")
        errors = entry.get("errors")
        if not isinstance(errors, dict) or not all(is_number(e) and not e < 0 for e in errors.values()):
            raise BadInput(f"{path}: {name}: 'errors' must be an object of numbers from 0 on")
    if CALIBRATION not in benchmarks:
        raise BadInput(f"{path}: no benchmark '{CALIBRATION}', nothing to compare by")
    return benchmarks, context


def cpu_model():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return "unknown"


def condense(path):
    """Google Benchmark's JSON as a result file: times, errors, and what of its context says no more than which kind
    of machine and build it was (no host name, no path, no date, no load)."""
    root = read_json(path)
    if not isinstance(root, dict) or not isinstance(root.get("benchmarks"), list) or \
            not isinstance(root.get("context"), dict):
        raise BadInput(f"{path}: not Google Benchmark's JSON")
    context = root["context"]
    benchmarks = {}
    try:
        runs = [run for run in root["benchmarks"] if run["run_type"] == "iteration"]
        # as in the source; interleaved ones come in a random order
        runs.sort(key=lambda run: (run["family_index"], run["per_family_instance_index"]))
        for run in runs:
            name = run["run_name"]
            if run.get("error_occurred"):
                raise BadInput(f"{path}: {name} failed: {run.get('error_message', '')}")
            errors = {k: float(f"{v:.6g}") for k, v in sorted(run.items()) if k not in NO_COUNTERS}
            entry = benchmarks.setdefault(name, {"time_ns": [], "errors": errors})
            # by their text, since NaN is not equal to itself
            if repr(entry["errors"]) != repr(errors):
                raise BadInput(f"{path}: {name}: errors differ between repetitions: {entry['errors']}, {errors}")
            # five digits: more than any clock is worth
            entry["time_ns"].append(float(f"{run['cpu_time'] * NANOSECONDS[run['time_unit']]:.5g}"))
        return {
            "format": FORMAT,
            "version": VERSION,
            "context": {
                "cpu": cpu_model(),
                "cores": context["num_cpus"],
                "compiler": context["compiler"],
                "build": context["build"],
            },
            "benchmarks": benchmarks,
        }
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise BadInput(f"{path}: not Google Benchmark's JSON of ltcfit_bench: {error!r}") from error


def write_result(result, path):
    """One line a benchmark, so that differences read well; whole or not at all."""
    lines = [f"  {json.dumps(name)}: {json.dumps(entry)}" for name, entry in result["benchmarks"].items()]
    text = "{\n" + "".join(f"{json.dumps(k)}: {json.dumps(result[k])},\n" for k in ("format", "version", "context"))
    text += '"benchmarks": {\n' + ",\n".join(lines) + "\n}\n}\n"
    temporary = None
    try:
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=os.path.dirname(path) or ".", delete=False) as file:
            temporary = file.name
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except OSError as error:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)
        print(f"{path}: {error.strerror}", file=sys.stderr)
        sys.exit(1)


def spread(times):
    """Interquartile range over median."""
    low, median, high = statistics.quantiles(times, n=4, method="inclusive")
    return (high - low) / median


def time_text(nanoseconds):
    for unit in ("ns", "us", "ms"):
        if nanoseconds < 1000 * NANOSECONDS[unit]:
            return f"{nanoseconds / NANOSECONDS[unit]:.4g} {unit}"
    return f"{nanoseconds * 1e-9:.4g} s"


def time_ratio(old, new, old_calibration, new_calibration):
    """Ratio of calibrated times and its uncertainty."""
    median = statistics.median
    ratio = (median(new) / median(new_calibration)) / (median(old) / median(old_calibration))
    return ratio, math.hypot(*map(spread, (old, new, old_calibration, new_calibration)))


def error_ratio(old, new):
    """How much an error rose; infinite where the new one is not finite or was none before."""
    if not math.isfinite(new):
        return math.inf
    if max(old, new) <= ROUNDING:
        return 1.0
    return new / old if old > 0 else math.inf


def describe(context):
    return ", ".join(f"{context.get(k, '?')}{' cores' if k == 'cores' else ''}"
                     for k in ("cpu", "cores", "compiler", "build"))


def print_table(benchmarks, against=None, limit=0.0, error_limit=0.0):
    """One row for each benchmark and its errors; returns what is flagged, one text each."""
    flagged = []
    columns = "  ratio     +-" if against else ""
    print(f"{'benchmark':<30} {'CPU time':>10} {'spread':>8}{columns}")
    for name, entry in benchmarks.items():
        times = entry["time_ns"]
        row = f"{name:<30} {time_text(statistics.median(times)):>10} {100 * spread(times):6.1f} %"
        old = against.get(name) if against else None
        if old is not None and name != CALIBRATION:
            ratio, uncertainty = time_ratio(old["time_ns"], times, against[CALIBRATION]["time_ns"],
                                            benchmarks[CALIBRATION]["time_ns"])
            row += f" {ratio:6.2f} {uncertainty:6.2f}"
            if ratio > max(limit, 1 + uncertainty):
                row += "  SLOWER"
                flagged.append(f"{name}: {ratio:.2f} times the baseline's time")
            elif 1 / ratio > max(limit, 1 + uncertainty):
                row += "  faster"
        print(row)
        for error, value in entry["errors"].items():
            text = f"  {error:<17} {value:.4g}"
            before = old["errors"].get(error) if old is not None else None
            if before is not None:
                change = error_ratio(before, value)
                text = f"{text:<50} {change:6.3f}"
                if change > error_limit:
                    text += "         WORSE"
                    flagged.append(f"{name}: {error} {value:.4g}, was {before:.4g}")
            print(text)
    return flagged


def missing_from(have, all_of):
    """Benchmarks, and errors of common benchmarks, that only `all_of` has."""
    out = [name for name in all_of if name not in have]
    for name in all_of:
        if name in have:
            out += [f"{name} {error}" for error in all_of[name]["errors"] if error not in have[name]["errors"]]
    return out


def compare(arguments):
    old, old_context = read_result(arguments.baseline)
    new, new_context = read_result(arguments.result)
    for name, entry in old.items():
        if not all(math.isfinite(e) for e in entry["errors"].values()):
            raise BadInput(f"{arguments.baseline}: {name}: an error that is not finite")
    print(f"{'baseline':<9} {describe(old_context)}\n{'result':<9} {describe(new_context)}")
    if old_context != new_context:
        print("another machine or build: ratios tell of it as well")
    print()
    flagged = print_table(new, old, arguments.limit, arguments.error_limit)
    lists = {"new": missing_from(old, new)}
    if not arguments.subset:
        lists["vanished"] = missing_from(new, old)
    print()
    for what, names in lists.items():
        if names:
            print(f"{what}: {', '.join(names)}")
    for text in flagged:
        print(f"flagged: {text}")
    if not flagged:
        print(f"nothing flagged (limits: time {arguments.limit:g} and the uncertainty, errors "
              f"{arguments.error_limit:g})")
    return 3 if flagged else 0


def limit_above_one(text):
    value = float(text)
    if not 1.0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text}, must be 1 or more")
    return value


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    sub = commands.add_parser("condense", help="write a result file from Google Benchmark's JSON output")
    sub.add_argument("raw", metavar="RAW.json",
                     help=f"of ltcfit_bench --benchmark_out, with {FEWEST} repetitions or more")
    sub.add_argument("result", metavar="RESULT.json", help="file to write")
    sub = commands.add_parser("show", help="print medians, spreads and errors of a result")
    sub.add_argument("result", metavar="RESULT.json")
    sub = commands.add_parser("compare", help="print a result next to a baseline; exit code 3 where it is worse")
    sub.add_argument("baseline", metavar="BASELINE.json")
    sub.add_argument("result", metavar="RESULT.json")
    sub.add_argument("--limit", type=limit_above_one, default=1.15, metavar="X",
                     help="ratio of calibrated times above which a benchmark is flagged, where the uncertainty is "
                          "below that; 1 or more (default: %(default)s)")
    sub.add_argument("--error-limit", type=limit_above_one, default=1.02, metavar="X",
                     help="ratio of errors above which a benchmark is flagged; 1 or more (default: %(default)s)")
    sub.add_argument("--subset", action="store_true",
                     help="the result is of some benchmarks only: do not list those that are missing in it")
    return parser.parse_args()


def run(arguments):
    if arguments.command == "condense":
        write_result(condense(arguments.raw), arguments.result)
        return 0
    if arguments.command == "show":
        benchmarks, context = read_result(arguments.result)
        print(f"{describe(context)}\n")
        print_table(benchmarks)
        return 0
    return compare(arguments)


def main():
    arguments = parse_arguments()
    try:
        code = run(arguments)
        if sys.stdout is None:
            raise OSError("standard output is closed")
        sys.stdout.flush()
        return code
    except BadInput as error:
        print(error, file=sys.stderr)
        return 2
    except OSError as error:
        print(f"cannot write: {error}", file=sys.stderr)
        # what is still buffered would fail again when the interpreter ends
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1


if __name__ == "__main__":
    sys.exit(main())
