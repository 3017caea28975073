#!/usr/bin/env python3
"""What reuse gains: the comparisons of docs/reuse.md, with one command. Prints their table as Markdown.

Everything is kept in the folder: scenes, references, one saved comparison for each name and its result. What is there
already is not done again, so an interrupted run continues, and the table contains all finished results.
"""
import argparse
import json
import pathlib
import subprocess
import sys
from dataclasses import dataclass, field

ROOT = pathlib.Path(__file__).resolve().parent.parent
WARM = "frames=1,warm-up=12"
LEARNS = "temporal=on,frames=4,warm-up=2"  # a short past pays where all time counts: more would show the same again


@dataclass
class Reference:
    """A reference image; `seed` is one that `compare` does not use."""

    scene: str
    integrator: str
    samples: int
    seed: int = 77
    options: list = field(default_factory=list)


@dataclass
class Comparison:
    reference: str
    methods: list
    options: list
    warm: bool = False


REFERENCES = {
    "building-1": Reference("building.pbrt", "restir-di:maxdepth=1,frames=16", 1008),
    "building-5": Reference("building.pbrt", f"restir-pt:maxdepth=5,{LEARNS}", 400),
    "terrace-1": Reference("terrace.pbrt", "restir-di:maxdepth=1,frames=16", 1008),
    "gallery-1": Reference("gallery.pbrt", "restir-di:maxdepth=1,frames=16", 1008),
    "glossy": Reference("glossy-indirect.pbrt", f"restir-pt:{LEARNS}", 2048, options=["--resolution", "160x120"]),
    "ajar": Reference("veach-ajar.pbrt", f"restir-pt:{LEARNS}", 256, options=["--resolution", "320x180"]),
}


def warm(reference, *methods, samples=2, repeats=8):
    return Comparison(reference, list(methods), ["--warm-frames", "--spp", samples, "--repeats", repeats], True)


def progressive(reference, seconds, *methods, repeats=4):
    """Each picture takes these seconds."""
    return Comparison(reference, list(methods), ["--time", f"{seconds * repeats}s", "--repeats", repeats])


DI_1, DI_5 = "restir-di:maxdepth=1", "restir-di:maxdepth=5"
PT_5, PT_5_ON = "restir-pt:maxdepth=5", "restir-pt:maxdepth=5,temporal=on"

COMPARISONS = {
    "building-1-warm": warm("building-1", "path:maxdepth=1", f"{DI_1},{WARM}"),
    "terrace-1-warm": warm("terrace-1", "path:maxdepth=1", f"{DI_1},{WARM}"),
    "gallery-1-warm": warm("gallery-1", "path:maxdepth=1", f"{DI_1},{WARM}"),
    "building-5-warm": warm("building-5", "path:maxdepth=5", f"{PT_5_ON},{WARM}", repeats=6),
    "building-5-warm-di": warm("building-5", "path:maxdepth=5", f"{DI_5},{WARM}", repeats=4),
    "glossy-warm": warm("glossy", "path", f"restir-pt:temporal=on,{WARM}"),
    "ajar-warm": warm("ajar", "path", f"restir-pt:temporal=on,{WARM}", repeats=6),
    "building-1-2.5s": progressive("building-1", 2.5, "path:maxdepth=1", DI_1),
    "gallery-1-2.5s": progressive("gallery-1", 2.5, "path:maxdepth=1", DI_1),
    "terrace-1-2.5s": progressive("terrace-1", 2.5, "path:maxdepth=1", DI_1),
    "building-5-2.5s": progressive("building-5", 2.5, "path:maxdepth=5", PT_5, f"{PT_5},{LEARNS}"),
    "glossy-2.5s": progressive("glossy", 2.5, "path", "restir-gi", "restir-pt", f"restir-pt:{LEARNS}"),
    "building-1-10s": progressive("building-1", 10, "path:maxdepth=1", DI_1),
    "building-5-10s": progressive("building-5", 10, "path:maxdepth=5", PT_5, f"{PT_5},{LEARNS}"),
    "terrace-1-10s": progressive("terrace-1", 10, "path:maxdepth=1", DI_1),
    "gallery-1-10s": progressive("gallery-1", 10, "path:maxdepth=1", DI_1),
    "glossy-10s": progressive("glossy", 10, "path", "restir-gi", "restir-pt", f"restir-pt:{LEARNS}"),
    "ajar-10s": progressive("ajar", 10, "path", "restir-pt", f"restir-pt:{LEARNS}"),
    "building-5-60s": progressive("building-5", 60, "path:maxdepth=5", f"{PT_5},{LEARNS}"),
    "building-1-60s": progressive("building-1", 60, "path:maxdepth=1", DI_1),
    "terrace-1-60s": progressive("terrace-1", 60, "path:maxdepth=1", DI_1),
    "gallery-1-60s": progressive("gallery-1", 60, "path:maxdepth=1", DI_1),
    "glossy-60s": progressive("glossy", 60, "path", f"restir-pt:{LEARNS}"),
}


def scene_file(name, folder, ajar):
    """Where a scene is; those that are made are made once. None: a scene that has not been given."""
    if name == "glossy-indirect.pbrt":
        return ROOT / "scenes" / "glossy-indirect" / name
    if name == "veach-ajar.pbrt":
        return ajar
    scenes = folder / "scenes"
    if not (scenes / name).exists():
        subprocess.run([sys.executable, ROOT / "bench" / "scenes" / "make_reuse_scenes.py", scenes], check=True)
    return scenes / name


def run(arguments, output):
    """Runs the program; its JSON goes to the file only if it ends well. Status 1: a verdict is refused, and it says so."""
    print("+", " ".join(map(str, arguments)), file=sys.stderr, flush=True)
    done = subprocess.run([str(a) for a in arguments], stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.returncode)
    output.write_text(done.stdout)


def make_reference(name, scene, settings):
    picture, reference = settings.folder / f"reference-{name}.exr", REFERENCES[name]
    if not picture.exists():
        unfinished = picture.with_name("unfinished.exr")
        run([settings.montelux, "render", scene, *reference.options, "--integrator", reference.integrator, "--spp",
             reference.samples, "--seed", reference.seed, "--quiet", "--json", "-o", unfinished],
            settings.folder / f"reference-{name}.json")
        unfinished.rename(picture)
    return picture


def compare(name, scene, picture, settings):
    result = settings.folder / f"{name}.json"
    if result.exists() and not settings.again:
        return
    comparison = COMPARISONS[name]
    methods = [part for letter, method in zip("abcdef", comparison.methods) for part in ("-" + letter, method)]
    options = [str(o) for o in comparison.options]
    if settings.repeats:
        at = options.index("--repeats") + 1
        if "--time" in options:
            time = options.index("--time") + 1
            options[time] = f"{float(options[time][:-1]) * settings.repeats / int(options[at])}s"
        options[at] = str(settings.repeats)
    run([settings.montelux, "compare", scene, *REFERENCES[comparison.reference].options, *methods, *options,
         "--reference", picture, "--clock", settings.clock, "--seed", settings.seed, "--no-slopes", "--no-attribution",
         "--quiet", "--json", "--save", settings.folder / f"{name}.saved"], result)


def number(x):
    return "-" if x is None else f"{x:.3g}"


def spread(measured):
    return f"**{number(measured['mean'])}** ({' to '.join(map(number, measured['interval']))})"


def inverse(ratio):
    if ratio["mean"] is None or None in ratio["interval"]:
        return {"mean": ratio["mean"] and 1 / ratio["mean"], "interval": [None, None]}
    low, high = ratio["interval"]
    return {"mean": 1 / ratio["mean"], "interval": [1 / high, 1 / low]}


def table(folder):
    """One line for each method against the first: how many times as efficient it is."""
    rows = ["| comparison | method | by MSE | by relMSE | with the time of warm-up | MSE of a sample | "
            "seconds of a sample | agrees |", "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for name, comparison in COMPARISONS.items():
        file = folder / f"{name}.json"
        if not file.exists():
            continue
        found = json.loads(file.read_text())
        for method in found["methods"]:
            samples = method["samples"]["mean"]
            row = [name, f"`{method['method']}`", "", "", "", number(method["mse"]["mean"] * samples),
                   number(method["seconds"]["mean"] / samples),
                   found["refused"] or ("no" if method["differs_from_reference"] else "yes")]
            for verdict in found["verdicts"]:
                if verdict["first"] != "a" or verdict["second"] != method["label"]:
                    continue
                row[2:4] = [spread(inverse(verdict[key])) for key in ("efficiency_ratio", "relative_efficiency_ratio")]
                if comparison.warm:
                    row[4] = spread(inverse(verdict["efficiency_ratio_with_warm_up"]))
            rows.append("| " + " | ".join(row) + " |")
    return "\n".join(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="comparisons; all by default: " +
                        ", ".join(COMPARISONS))
    parser.add_argument("-o", "--output", dest="folder", type=pathlib.Path, default=pathlib.Path("reuse_gain.out"))
    parser.add_argument("--montelux", default=ROOT / "build" / "release" / "montelux", help="the program")
    parser.add_argument("--ajar", type=pathlib.Path, help="veach-ajar.pbrt, which is not among the bundled scenes")
    parser.add_argument("--references", action="store_true", help="only make the references, which are not timed")
    parser.add_argument("--table", action="store_true", help="only print the table of what is there")
    parser.add_argument("--again", action="store_true", help="measure again what is there")
    parser.add_argument("--repeats", type=int, help="of each comparison, each as long as it would be else")
    parser.add_argument("--clock", choices=["wall", "processor"], default="wall", help="processor: for a busy machine")
    parser.add_argument("--seed", type=int, default=0)
    settings = parser.parse_args()
    unknown = [name for name in settings.names if name not in COMPARISONS]
    if unknown:
        parser.error(f"there is no comparison {', '.join(unknown)}; there are {', '.join(COMPARISONS)}")
    settings.folder.mkdir(parents=True, exist_ok=True)
    for name in [] if settings.table else settings.names or COMPARISONS:
        reference = COMPARISONS[name].reference
        scene = scene_file(REFERENCES[reference].scene, settings.folder, settings.ajar)
        if scene is None:
            print(f"{name}: left out, its scene is not given (--ajar)", file=sys.stderr)
            continue
        picture = make_reference(reference, scene, settings)
        if not settings.references:
            compare(name, scene, picture, settings)
    print(table(settings.folder))


if __name__ == "__main__":
    main()
