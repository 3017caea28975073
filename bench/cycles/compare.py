#!/usr/bin/env python3
"""Inefficiency (relMSE x processor seconds) of Montelux and of Cycles on the same Cornell box, interleaved.

usage: bench/cycles/compare.py [--montelux PATH] [--width W] [--samples N] [--pictures K] [--threads T] [--work DIR]

Needs blender, oiiotool and numpy. Each renderer is compared with the mean of its own images: v is the variance over
the K pictures per pixel and channel, m their mean, relMSE = mean(v / (m^2 + 0.01)). Time is the slope of user + system
seconds between N / 8 and N samples, so that loading is counted apart."""
import argparse
import os
import resource
import statistics
import struct
import subprocess
import sys

import numpy

HERE = os.path.dirname(os.path.abspath(__file__))


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit("failed: %s\n%s" % (" ".join(command), done.stdout[-3000:]))
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def pixels(path):
    """The colour of an EXR file, by way of an uncompressed TIFF file of floats."""
    tif = path + ".tif"
    subprocess.run(["oiiotool", path, "--ch", "R,G,B", "-d", "float", "--compression", "none", "--scanline", "-o", tif],
                   check=True, stdout=subprocess.DEVNULL)
    with open(tif, "rb") as f:
        data = f.read()
    order = "<" if data[:2] == b"II" else ">"
    entries = {}
    (at,) = struct.unpack_from(order + "I", data, 4)
    (count,) = struct.unpack_from(order + "H", data, at)
    for i in range(count):
        tag, kind, n, _ = struct.unpack_from(order + "HHII", data, at + 2 + 12 * i)
        code, size = {3: ("H", 2), 4: ("I", 4)}.get(kind, (None, 0))
        if code is None:
            continue
        where = at + 2 + 12 * i + 8
        if n * size > 4:
            (where,) = struct.unpack_from(order + "I", data, where)
        entries[tag] = struct.unpack_from(order + code * n, data, where)
    strips = b"".join(data[o:o + n] for o, n in zip(entries[273], entries[279]))
    return numpy.frombuffer(strips, order + "f4").reshape(entries[257][0], entries[256][0], 3).astype(float)


def relative_mse(pictures, trim=0.0):
    stack = numpy.stack(pictures)
    per_value = (stack.var(axis=0, ddof=1) / (stack.mean(axis=0) ** 2 + 0.01)).ravel()
    if trim:
        per_value = numpy.sort(per_value)[: int(len(per_value) * (1 - trim))]
    return per_value.mean()


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--montelux", default=os.path.join(HERE, "../../build/release/montelux"))
    p.add_argument("--width", type=int, default=256)
    p.add_argument("--samples", type=int, default=64)
    p.add_argument("--pictures", type=int, default=6)
    p.add_argument("--threads", type=int, default=1)
    p.add_argument("--sampler", default="blue-noise")
    p.add_argument("--work", default="/tmp/montelux-cycles")
    a = p.parse_args()
    os.makedirs(a.work, exist_ok=True)
    subprocess.run([sys.executable, os.path.join(HERE, "cornell.py"), a.work, str(a.width)], check=True)

    def montelux(samples, seed, out):
        return [a.montelux, "render", a.work + "/cornell.pbrt", "-o", out, "--spp", str(samples), "--seed", str(seed),
                "--threads", str(a.threads), "--sampler", a.sampler, "--quiet"]

    def cycles(samples, seed, out):
        return ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python",
                os.path.join(HERE, "render_cycles.py"), "--", a.work + "/cornell.gltf", out, str(a.width), str(samples),
                str(seed), str(a.threads)]

    renderers = {"montelux": montelux, "cycles": cycles}
    times = {name: {a.samples: [], a.samples // 8: []} for name in renderers}
    pictures = {name: [] for name in renderers}
    for k in range(a.pictures):
        for name, command in renderers.items():
            out = "%s/%s-%d.exr" % (a.work, name, k)
            times[name][a.samples].append(cpu_seconds(command(a.samples, k + 1, out)))
            pictures[name].append(pixels(out))
            times[name][a.samples // 8].append(
                cpu_seconds(command(a.samples // 8, k + 1, a.work + "/" + name + "-short.exr")))
    inefficiency = {}
    for name in renderers:
        full, short = (statistics.median(times[name][n]) for n in (a.samples, a.samples // 8))
        slope = (full - short) / (1 - 1 / 8)
        noise, trimmed = relative_mse(pictures[name]), relative_mse(pictures[name], 0.001)
        inefficiency[name] = noise * slope
        rate = a.width ** 2 * a.samples / slope / 1e6
        print("%-9s mean %.5f  seconds %.3f (whole program %.3f)  %.3f M samples/s  relMSE %.5g (%.5g without the worst "
              "0.1 %%)  inefficiency %.5g" % (name, numpy.mean(pictures[name]), slope, full, rate, noise, trimmed,
                                              inefficiency[name]))
    print("inefficiency montelux / cycles: %.3f" % (inefficiency["montelux"] / inefficiency["cycles"]))


if __name__ == "__main__":
    main()
