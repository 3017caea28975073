#!/usr/bin/env python3
"""What a history is worth in a sequence: the table of docs/reuse.md, with one command. Prints it as Markdown.

Every way renders the same short flight with several seeds. The error of a picture is its variance over the seeds, over
the squared mean of all of them, times its samples; in parentheses its 95 % interval, by leaving each seed out in turn.
"""
import argparse
import array
import math
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURES, SERIES, SEEDS = 6, 8, 8
STUDENT = 2.365  # 97.5 %, one degree of freedom less than seeds
WAYS = ["candidates=1,neighbours=0", "candidates=1", "candidates=8,visibility-reuse=off"]
SCENES = ["pan-grey", "pan-colour"]


def read_pfm(path):
    kind, _, scale, data = path.read_bytes().split(b"\n", 3)
    if kind != b"PF" or float(scale) >= 0:
        sys.exit(f"{path}: not a colour PFM of little-endian numbers")
    return array.array("f", data)


def render(settings, scene, way, seed):
    """The first and the last picture."""
    pattern = settings.folder / "picture.#.pfm"
    subprocess.run([settings.montelux, "render", scene, "--frames", f"0:{PICTURES - 1}/{PICTURES}", "--integrator",
                    f"restir-di:frames=1,{way}", "--spp", str(SERIES), "--seed", str(seed), "--quiet", "-o", pattern],
                   check=True, stdout=subprocess.DEVNULL)
    return [read_pfm(settings.folder / f"picture.{k}.pfm") for k in (0, PICTURES - 1)]


def relative_error(sums, squares, n):
    """Of one picture, the mean over its pixels and components."""
    total = 0.0
    for s, q in zip(sums, squares):
        mean = s / n
        total += (q - s * mean) / (n - 1) / (mean * mean + 0.01)
    return total * SERIES / len(sums)


def error(pictures):
    """And half of its 95 % interval, by a jackknife."""
    n = len(pictures)
    sums = [math.fsum(v) for v in zip(*pictures)]
    squares = [math.fsum(x * x for x in v) for v in zip(*pictures)]
    whole = relative_error(sums, squares, n)
    without = [relative_error([s - x for s, x in zip(sums, p)], [q - x * x for q, x in zip(squares, p)], n - 1)
               for p in pictures]
    pseudo = [n * whole - (n - 1) * w for w in without]
    mean = sum(pseudo) / n
    return whole, STUDENT * math.sqrt(sum((p - mean) ** 2 for p in pseudo) / (n - 1) / n)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--montelux", default=ROOT / "build" / "release" / "montelux", type=pathlib.Path)
    parser.add_argument("-o", "--folder", default=pathlib.Path("history_gain.out"), type=pathlib.Path)
    settings = parser.parse_args()
    settings.folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([sys.executable, ROOT / "bench" / "scenes" / "make_reuse_scenes.py", settings.folder], check=True)
    print("| scene | `restir-di:frames=1,...` | first | sixth | sixth, `carry=off` |\n| --- | --- | --- | --- | --- |")
    for scene in SCENES:
        for way in WAYS:
            cells = []
            for more, wanted in ("", (0, 1)), (",carry=off", (1,)):
                runs = [render(settings, settings.folder / f"{scene}.pbrt", way + more, seed)
                        for seed in range(SEEDS)]
                cells += ["%.3g ± %.1g" % error([run[k] for run in runs]) for k in wanted]
            print(f"| {scene} | `{way}` | {' | '.join(cells)} |", flush=True)


main()
