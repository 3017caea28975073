#!/usr/bin/env python3
"""What --integrator auto gains over path: the table of docs/integrators.md.

Renders each scene within the same times by both, in turns, pilots and all, and compares the images with a long render of another
seed. "gain" is the ratio of relative mean squared errors times processor time, in the mean over the seeds, without the loading of
the scene. For each choice its own estimate of the ratio and the share of the pilots are printed.
"""
import argparse
import json
import math
import os
import pathlib
import subprocess
import tempfile

from target_error import read_pfm


def relative_error(image, true):
    return sum((x - t) ** 2 / (t ** 2 + 0.01) for x, t in zip(image, true)) / len(true)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--montelux", default="build/release/montelux")
    parser.add_argument("--times", default="4s:3,30s:2", help="seconds of a render, and the number of seeds, for each length")
    parser.add_argument("--reference", default="path", help="integrator of the reference")
    parser.add_argument("--reference-time", default="90s")
    parser.add_argument("--resolution", default="256x144")
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    print("| scene | time | samples of path | relMSE path | auto | gain | of each seed | choices (estimated ratio; share of pilots) |\n"
          "| --- | --- | ---: | ---: | ---: | ---: | --- | --- |")
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "image.pfm"

        def run(scene, seed, *options):
            command = [arguments.montelux, "render", scene, "--resolution", arguments.resolution, "--quiet", "--json", "--seed", seed,
                       "--threads", arguments.threads, "-o", file, *options]
            before = os.times()
            stated = json.loads(subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout)
            after = os.times()
            return stated, read_pfm(file), after.children_user - before.children_user

        for scene in arguments.scenes:
            reference, true, _ = run(scene, 1000001, "--time", arguments.reference_time, "--integrator", arguments.reference)
            loading = min(run(scene, 1, "--spp", 1)[2] for _ in range(2))
            for length in arguments.times.split(","):
                time, seeds = length.split(":")
                found, choices = {}, []
                for seed in range(int(seeds)):
                    for way in "path", "auto":
                        stated, image, seconds = run(scene, seed, "--time", time, "--integrator", way)
                        error = max(relative_error(image, true) - reference["relative_mse"], 1e-30)
                        found.setdefault(way, []).append((error, seconds - loading))
                        if way == "auto":
                            choice = stated["choice"]
                            best = choice["candidates"][0] if choice["candidates"] else {"integrator": "-", "efficiency": math.nan,
                                                                                        "interval": [math.nan, math.nan]}
                            choices.append("{} (of {} {:.3g}, {:.3g} to {:.3g}; {:.1f} %)".format(
                                choice["integrator"], best["integrator"], best["efficiency"], *best["interval"], 100 * choice["pilots"]))
                        else:
                            samples = stated["passes"] * stated["samples_per_pass"]
                error, seconds = ({way: sum(r[i] for r in runs) / len(runs) for way, runs in found.items()} for i in range(2))
                gain = error["path"] / error["auto"] * seconds["path"] / seconds["auto"]
                of_seeds = [p[0] * p[1] / (a[0] * a[1]) for p, a in zip(found["path"], found["auto"])]
                print(f"| {scene.stem} | {time} | {samples:.3g} | {error['path']:.3g} | {error['auto']:.3g} | {gain:.2f} | "
                      f"{', '.join(f'{g:.2f}' for g in of_seeds)} | {'; '.join(choices)} |", flush=True)
            print(f"reference of {scene.stem}: {reference['relative_mse']:.3g}", flush=True)


if __name__ == "__main__":
    main()
