#!/usr/bin/env python3
"""What --adaptive on gains: the table of docs/targets.md.

Renders each scene with as many samples in both ways and compares the images with a long render of another seed. "gain" is the
ratio of relative mean squared errors times processor time, in the mean over the seeds; its error is the standard error over them.
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
    total = 0.0
    for i in range(len(true)):
        total += (image[i] - true[i]) ** 2 / (true[i] ** 2 + 0.01)
    return total / len(true)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--montelux", default="build/release/montelux")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--runs", type=int, default=8)
    parser.add_argument("--reference", type=int, default=8192, help="samples per pixel of the reference")
    parser.add_argument("--resolution", default="128x96")
    arguments = parser.parse_args()
    print("| scene | relMSE uniform | adaptive | samples, adaptive / uniform | gain at equal samples | rays | time |\n"
          "| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    gains = []
    with tempfile.TemporaryDirectory() as name:
        file = pathlib.Path(name) / "image.pfm"

        def run(scene, seed, *options, threads=1):
            command = [arguments.montelux, "render", scene, "--resolution", arguments.resolution, "--quiet", "--json", "--seed", seed,
                       "--threads", threads, "-o", file, *options]
            before = os.times()
            stated = json.loads(subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout)
            after = os.times()
            return stated, read_pfm(file), after.children_user - before.children_user

        for scene in arguments.scenes:
            reference, true, seconds = run(scene, 1000001, "--spp", arguments.reference, threads=2)
            loading = min(run(scene, 1, "--spp", 1)[2] for i in range(2))
            found = {}
            for seed in range(arguments.runs):
                for way in "off", "on":
                    stated, image, seconds = run(scene, seed, "--spp", arguments.spp, "--adaptive", way)
                    error = max(relative_error(image, true) - reference["relative_mse"], 1e-30)
                    found.setdefault(way, []).append((error, max(seconds - loading, 1e-3), stated["samples"],
                                                        stated["rays"]))
            error, seconds, samples, rays = ({way: sum(r[i] for r in runs) / len(runs) for way, runs in found.items()} for i in range(4))
            share = samples["on"] / samples["off"]
            at_samples = error["off"] / error["on"] / share
            at_time = error["off"] / error["on"] * seconds["off"] / seconds["on"]
            at_rays = error["off"] / error["on"] * rays["off"] / rays["on"]
            gains.append((at_samples, at_rays, at_time))
            print(f"| {scene.stem} | {error['off']:.3g} | {error['on']:.3g} | {share:.3f} | {at_samples:.2f} | {at_rays:.2f} | {at_time:.2f} |", flush=True)
    for i, what in enumerate(("samples", "rays", "time")):
        logs = [math.log(gain[i]) for gain in gains]
        print(f"\nat equal {what}: geometric mean {math.exp(sum(logs) / len(logs)):.2f}, least {math.exp(min(logs)):.2f}")


if __name__ == "__main__":
    main()
