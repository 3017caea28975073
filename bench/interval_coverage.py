#!/usr/bin/env python3
"""How often the intervals of pixels contain the truth, and how wide they are: a table of docs/error-bars.md.

Renders each scene with several seeds and numbers of samples, and compares the intervals with a long render of another
seed, whose own error is added to them. Pixels without noise do not count. Needs oiiotool (openimageio-tools).
"""
import argparse
import array
import math
import pathlib
import struct
import subprocess
import tempfile

CLASSES = ("dark", "shadow edges", "object edges", "lamp edges", "noisiest tenth")


def read_exr(path):
    """The size of an uncompressed .exr of 32-bit floats, and its channels by name, as lists of numbers from the top left."""
    data = path.read_bytes()
    header, at = {}, 8
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 6
        size, = struct.unpack("<i", data[at - 4:at])
        header[name.decode()] = data[at:at + size]
        at += size
    names, rest = [], header["channels"]
    while rest[0]:
        name, rest = rest.split(b"\0", 1)
        assert rest[0] == 2, "it has channels that are not 32-bit floats"
        names.append(name.decode())
        rest = rest[16:]
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    assert header["compression"] == b"\0"
    planes = {name: array.array("f", bytes(4 * width * height)) for name in names}
    first = at + 1
    for k in range(height):
        place, = struct.unpack_from("<Q", data, first + 8 * k)
        y, size = struct.unpack_from("<ii", data, place)
        values, row = array.array("f", data[place + 8:place + 8 + size]), y - y0
        for c, name in enumerate(names):
            planes[name][row * width:(row + 1) * width] = values[c * width:(c + 1) * width]
    return width, height, planes


class Picture:
    """The channels, each as a list for all pixels."""

    def __init__(self, path):
        self.width, self.height, self.planes = read_exr(path)

    def layer(self, name):
        return [self.planes[f"{name}.{c}" if name else c] for c in "RGB"]


def classes_of(truth):
    """For each class the pixels that belong to it."""
    width, height = truth.width, truth.height
    light = [sum(pixel) / 3 for pixel in zip(*truth.layer(""))]
    noise = [math.sqrt(sum(e * e for e in pixel) / 3) for pixel in zip(*truth.layer("stderr"))]
    features = [truth.planes[c] for c in ("albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z")]
    mean = sum(light) / len(light)
    relative = [n / (m + 0.01 * mean) for n, m in zip(noise, light)]
    tenth = sorted(relative)[len(relative) * 9 // 10]
    found = {name: set() for name in CLASSES}
    for i in range(width * height):
        x, y = i % width, i // width
        around = [v * width + u for v in range(max(y - 1, 0), min(y + 2, height))
                  for u in range(max(x - 1, 0), min(x + 2, width))]
        most, least = max(light[k] for k in around), min(light[k] for k in around)
        unlike = max(max(plane[k] for k in around) - min(plane[k] for k in around) for plane in features)
        is_in = (light[i] < mean / 4, most > 2 * least and unlike < 0.1, unlike > 0.3,
                 most > 5 * mean and least < 2 * mean, relative[i] > tenth)
        for name, member in zip(CLASSES, is_in):
            if member:
                found[name].add(i)
    return found


class Figures:
    """Sums over pixels, channels and seeds."""

    def __init__(self):
        self.covered = self.count = self.by_student = 0
        self.width = 0.0
        self.classes = {name: [0, 0] for name in CLASSES}

    def add(self, picture, truth, classes, quantile):
        members = [[name for name in CLASSES if i in classes[name]] for i in range(picture.width * picture.height)]
        layers = [*map(picture.layer, ("", "stderr", "low", "high")), truth.layer(""), truth.layer("stderr")]
        for means, errors, lows, highs, trues, doubts in zip(*layers):
            for mean, error, low, high, true, doubt, own in zip(means, errors, lows, highs, trues, doubts, members):
                if doubt <= 1e-6 * abs(true):
                    continue
                below, above = math.hypot(mean - low, 1.96 * doubt), math.hypot(high - mean, 1.96 * doubt)
                covered = mean - below <= true <= mean + above
                self.covered += covered
                self.count += 1
                self.by_student += abs(mean - true) <= math.hypot(quantile * error, 1.96 * doubt)
                self.width += (high - low) / 2
                for name in own:
                    self.classes[name][0] += covered
                    self.classes[name][1] += 1


def oracle_width(pictures, truth):
    """The sum over pixels of 1.96 standard errors, these from the passes of all seeds."""
    total = 0.0
    for c in range(3):
        doubts, trues = truth.layer("stderr")[c], truth.layer("")[c]
        errors = [picture.layer("stderr")[c] for picture in pictures]
        for i, (doubt, true) in enumerate(zip(doubts, trues)):
            if doubt > 1e-6 * abs(true):
                total += 1.96 * math.sqrt(sum(e[i] ** 2 for e in errors) / len(errors))
    return total


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="+", type=pathlib.Path)
    parser.add_argument("--montelux", default="build/release/montelux")
    parser.add_argument("--samples", default="16,64,256,1024", help="samples per pixel, separated by commas")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--reference", type=int, default=8192, help="samples per pixel of the reference")
    parser.add_argument("--resolution", default="80x48")
    parser.add_argument("--sampler", default="blue-noise")
    arguments = parser.parse_args()
    print("| scene | samples | t alone | intervals | " + " | ".join(CLASSES) + " | width |\n" +
          "| --- |" + " ---: |" * (4 + len(CLASSES)))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for scene in arguments.scenes:

            def render(samples, seed):
                file, plain = folder / "picture.exr", folder / "plain.exr"
                subprocess.run([arguments.montelux, "render", scene, "--integrator", "path", "--resolution", arguments.resolution,
                                "--sampler", arguments.sampler, "--spp", str(samples), "--seed", str(seed), "--layers",
                                "intervals", "--quiet", "-o", file], check=True, stdout=subprocess.DEVNULL)
                subprocess.run(["oiiotool", file, "-d", "float", "--compression", "none", "--scanline", "-o", plain], check=True)
                return Picture(plain)

            truth = render(arguments.reference, 999)
            classes = classes_of(truth)
            for samples in map(int, arguments.samples.split(",")):
                # Student's t for the passes that plan_passes() chooses.
                quantile = (2.131 if samples < 64 else 1.998) if arguments.sampler == "independent" else 2.365
                pictures = [render(samples, seed) for seed in range(1, arguments.seeds + 1)]
                figures = Figures()
                for picture in pictures:
                    figures.add(picture, truth, classes, quantile)
                cells = [f"{100 * covered / count:.0f}" if count >= 200 else "-"
                         for covered, count in figures.classes.values()]
                print(f"| {scene.stem} | {samples} | {100 * figures.by_student / figures.count:.1f} % | "
                      f"{100 * figures.covered / figures.count:.1f} % | " + " | ".join(cells) +
                      f" | {figures.width / oracle_width(pictures, truth) / arguments.seeds:.2f} |", flush=True)


if __name__ == "__main__":
    main()
