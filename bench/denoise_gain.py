#!/usr/bin/env python3
"""What the removal of noise gains, and whether the error that it states is true: the table of docs/denoising.md.

Renders each scene with few samples, removes the noise, and compares both with a long render of another seed.
"""
import argparse
import array
import json
import math
import pathlib
import subprocess
import tempfile


def read_pfm(path):
    """The numbers of the pixels, three each."""
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    assert kind == b"PF" and float(scale) == -1
    return array.array("f", data)


def relative_error(picture, true, variance):
    """Mean of the squared errors over the squares of the reference plus 0.01, less that of the reference."""
    total = 0.0
    for value, of_true in zip(picture, true):
        total += (value - of_true) ** 2 / (of_true ** 2 + 0.01)
    return total / len(true) - variance


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--montelux", default="build/release/montelux")
    parser.add_argument("--samples", default="16,64", help="samples per pixel, separated by commas")
    parser.add_argument("--reference", type=int, default=1024, help="samples per pixel of the reference")
    parser.add_argument("--resolution", default="256x144")
    arguments = parser.parse_args()
    gains = {}
    print("| scene | samples | relMSE | denoised | gain | stated / true error | FLIP | denoised |\n| --- |" + " ---: |" * 7)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*options):
            command = [arguments.montelux, *map(str, options), "--json"]
            return json.loads(subprocess.run(command, check=options[0] != "diff", capture_output=True, text=True).stdout)

        for scene in arguments.scenes:
            render = ["render", scene, "--integrator", "path", "--resolution", arguments.resolution]
            reference = run(*render, "--spp", arguments.reference, "--seed", 99, "-o", folder / "true.pfm")
            true, variance = read_pfm(folder / "true.pfm"), reference["relative_mse"]
            for samples in map(int, arguments.samples.split(",")):
                run(*render, "--spp", samples, "--seed", 5, "--layers", "halves", "-o", folder / "noisy.exr", "-o",
                    folder / "noisy.pfm")
                stated = run("denoise", folder / "noisy.exr", "-o", folder / "clean.pfm")["denoised"]["relative_mse"]
                before, after = (relative_error(read_pfm(folder / f"{k}.pfm"), true, variance) for k in ("noisy", "clean"))
                flip = [run("diff", folder / f"{k}.pfm", folder / "true.pfm")["flip"] for k in ("noisy", "clean")]
                if before > 0 and after > 0:
                    gains.setdefault(samples, []).append(before / after)
                # Where the reference is not exact enough, nothing is known of the error that is left.
                ratio = math.sqrt(stated / after) if after > 0 else math.nan
                print(f"| {scene.stem} | {samples} | {before:.3g} | {after:.3g} | {before / after:.1f} | {ratio:.2f} | "
                      f"{flip[0]:.3f} | {flip[1]:.3f} |", flush=True)
    for samples, all_gains in gains.items():
        mean = math.exp(sum(map(math.log, all_gains)) / len(all_gains))
        print(f"\n{samples} samples: geometric mean {mean:.1f}, least {min(all_gains):.1f}")


if __name__ == "__main__":
    main()
