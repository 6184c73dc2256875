#!/usr/bin/env python3
"""Bytes of tailored tables against their error, for several scenes.

Fits the tables of each scene at several bounds (ltcfit fit --scene --max-error) and prints, as Markdown, size and
measured error of each, next to those of the full table over the same look-ups; -o also writes them as JSON. Ten
minutes on two cores.

usage: scripts/scene_curves.py [--ltcfit build/ltcfit] [-o FILE.json] [SCENE ...]
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENES = ["plain.gltf", "satin.json", "metal_rough.gltf", "brushed.json", "lamp.glb", "lobby.json"]
BOUNDS = [0.004, 0.002, 0.001]


def fit(program, scene, bound, verify, folder):
    command = [program, "fit", "--scene", str(scene), "--max-error", str(bound), "--json", "-q",
               "-o", os.path.join(folder, "table.json")]
    if verify:
        command += ["--verify", "--full", str(ROOT / "data/ltc_iso.json"), "--full", str(ROOT / "data/ltc_aniso.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode == 3 and not done.stdout:
        return None  # out of reach
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(command)}: {done.stderr}")
    return json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--ltcfit", default=str(ROOT / "build/ltcfit"))
    parser.add_argument("-o", "--output")
    parser.add_argument("scenes", nargs="*", default=[str(ROOT / "data/scenes" / name) for name in SCENES])
    arguments = parser.parse_args()

    points = []
    print("| scene | table | bound | nodes | bytes | of the full table | mean error | p99 | full table's mean |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scenes:
            full = {}
            for bound in reversed(BOUNDS):  # the finest bound of a scene also judges the full table
                result = fit(arguments.ltcfit, scene, bound, not full, folder)
                if result is None:
                    continue
                for table in result["tables"]:
                    kind = table["kind"]
                    if "verification" in table:
                        full[kind] = table["verification"]["full"]["mean"]
                    everything = 64 * 64 * 12 if kind == "isotropic" else 8**4 * 24
                    point = {"scene": pathlib.Path(scene).name, "kind": kind, "bound": bound, "nodes": table["nodes"],
                             "bytes": table["bytes"], "share": table["bytes"] / everything,
                             "mean": table["error"]["mean"], "p99": table["error"]["p99"],
                             "full_mean": full.get(kind)}
                    points.append(point)
                    print(f"| {point['scene']} | {kind} | {bound:g} | {' × '.join(map(str, table['nodes']))} | "
                          f"{point['bytes']} | {100 * point['share']:.2g} % | {point['mean']:.2g} | "
                          f"{point['p99']:.2g} | {point['full_mean'] or float('nan'):.2g} |", flush=True)
    if arguments.output:
        folder = os.path.dirname(arguments.output) or "."
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", dir=folder, delete=False) as file:
            json.dump({"format": "ltc-scene-curves", "version": 1, "points": points}, file, indent=1)
            file.write("\n")
        os.chmod(file.name, 0o644)
        os.replace(file.name, arguments.output)


if __name__ == "__main__":
    main()
