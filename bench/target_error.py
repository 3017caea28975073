#!/usr/bin/env python3
"""Whether renders to a requested error have it, and what that costs: the table of docs/targets.md.

Renders each scene to the target with many seeds and compares the images with a long render of other seeds. "reached" is the
share of the runs that state it, "within" the share of these whose true error is within the target. The shortest run that would
have done is the least number of samples (of --spp) at which that share of other runs is within the target.
The bias is the mean of the differences of the image means from that of the reference, in units of its own standard error.
"""
import argparse
import array
import concurrent.futures
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


class Target:
    def __init__(self, text):
        self.text = text
        self.measure = text.split(":")[0] if ":" in text else "relative"
        numbers = text.split(":")[-1].split("@")
        self.error = float(numbers[0].rstrip("%")) / 100
        self.share = float(numbers[1].rstrip("%")) / 100 if len(numbers) > 1 else None

    def true_error(self, image, true, variances):
        """Of the image against a reference, whose own variance is subtracted."""
        if self.measure == "mean":
            return abs(math.fsum(image) / math.fsum(true) - 1)
        squares = []
        for i in range(0, len(true), 3):
            square = sum((image[k] - true[k]) ** 2 / (true[k] ** 2 + 0.01) for k in range(i, i + 3)) / 3
            squares.append(square)
        if self.measure == "pixels":
            return math.sqrt(sorted(squares)[math.ceil(self.share * len(squares)) - 1])
        return math.sqrt(max(math.fsum(squares) / len(squares) - variances, 0))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--montelux", default="build/release/montelux")
    parser.add_argument("--target", default="5%", help="as --target-error has it")
    parser.add_argument("--option", action="append", default=[], help="one more option of the renders to the target, such as --unbiased")
    parser.add_argument("--spp", default=16384, type=int, help="the most samples per pixel")
    parser.add_argument("--runs", default=200, type=int)
    parser.add_argument("--jobs", default=1, type=int, help="renders at a time, of one thread each")
    parser.add_argument("--reference", type=int, default=32, help="samples of the reference, over the most of a run")
    parser.add_argument("--reference-samples", type=int, help="samples per pixel of the reference instead")
    parser.add_argument("--resolution", default="64x48")
    parser.add_argument("--shortest", action="store_true", help="measure the shortest run, too")
    arguments = parser.parse_args()
    target = Target(arguments.target)
    print("| scene | reached | within | mean of true / target | samples | over the shortest | bias of the mean |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        folder = pathlib.Path(name)

        def run(scene, seed, *options, threads=1):
            file = folder / f"{seed}.pfm"
            command = [arguments.montelux, "render", scene, "--resolution", arguments.resolution, "--quiet", "--json", "--seed", seed,
                       "--threads", threads, "-o", file, *options]
            stated = json.loads(subprocess.run(list(map(str, command)), check=True, capture_output=True, text=True).stdout)
            image = read_pfm(file)
            file.unlink()
            return stated, image

        for scene in arguments.scenes:
            options = ["--target-error", target.text, "--spp", arguments.spp, *arguments.option]
            runs = list(pool.map(lambda seed: run(scene, seed, *options), range(arguments.runs)))
            samples = [stated["passes"] * stated["samples_per_pass"] for stated, image in runs]
            mean = sum(samples) / len(samples)
            length = arguments.reference_samples or int(arguments.reference * mean)
            reference, true = run(scene, 1000001, "--spp", length, threads=max(arguments.jobs, 1))
            errors = [target.true_error(image, true, reference["relative_mse"]) for stated, image in runs]
            reached = [error for (stated, image), error in zip(runs, errors) if stated["target"]["reached"]]
            within = sum(error <= target.error for error in reached)
            differences = [math.fsum(image) / math.fsum(true) - 1 for stated, image in runs]
            average = sum(differences) / len(differences)
            spread = math.sqrt(sum((d - average) ** 2 for d in differences) / max(len(differences) - 1, 1) / len(differences))
            of_reference = sum(reference["standard_error"]) / sum(reference["mean"])
            over = "-"
            if arguments.shortest and reached:
                filtered = ["--denoise"] if target.measure == "denoised" else []
                shortest = shortest_run(lambda spp, seed: target.true_error(
                    run(scene, 2000000 + seed, "--spp", spp, *filtered)[1], true, reference["relative_mse"]), target.error, mean, pool)
                over = f"{mean / shortest:.2f}"
            print(f"| {scene.stem} | {100 * len(reached) / len(runs):.0f} % | {100 * within / max(len(reached), 1):.1f} % ({within}/{len(reached)}) "
                  f"| {sum(errors) / len(errors) / target.error:.3f} | {mean:.0f} | {over} "
                  f"| {100 * average:+.4f} % ± {100 * math.hypot(spread, of_reference):.4f} % |", flush=True)


def shortest_run(error_of, target, begin, pool, confidence=0.95, runs=40):
    """The least number of samples at which this share of the runs is within the target: first in steps of a tenth, then
    between the last two by bisection with three times as many runs."""
    def suffices(samples, runs):
        errors = list(pool.map(lambda seed: error_of(samples, seed), range(runs)))
        return sum(error <= target for error in errors) >= confidence * runs

    enough = int(begin)
    while enough > 1:
        few = min(int(enough / 1.1), enough - 1)
        if not suffices(few, runs):
            break
        enough = few
    else:
        return 1
    while enough - few > max(enough // 40, 1):
        middle = (enough + few) // 2
        if suffices(middle, 3 * runs):
            enough = middle
        else:
            few = middle
    return (enough + few) / 2


if __name__ == "__main__":
    main()
