#!/usr/bin/env python3
"""Writes the scenes of this folder and expected.json: one scene for each class of paths L(S|D)*E (Heckbert 1990), its
mean in theory, and which integrators find it. Formulas are those of ../analytic/expected.py, with nothing of Montelux.

Few paths from a light arrive in the small window that the camera looks at. For them the window and the floor are made
wider (WIDE), and the mean is that of the formula over the window. Photons are looked up within a radius: for them the
window ends before the floor does, and mirrors in view are larger and further from it (PHOTONS).
"""
import json
import os
import sys
from math import cos, pi, radians

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "analytic"))
from expected import fresnel_metal, point, polygon  # noqa: E402

HEAD = """# {title}
# The mean of the picture is stated in expected.json; expected.py writes both.

Film "rgb" "integer xresolution" [ 8 ] "integer yresolution" [ 8 ] "string filename" [ "{name}.exr" ]
Sampler "zsobol" "integer pixelsamples" [ 256 ]
Integrator "path"
PixelFilter "box"
{camera}
Camera "orthographic" "float screenwindow" [ -1e-3 1e-3 -1e-3 1e-3 ]

WorldBegin

{world}"""

DOWN = "LookAt 0 0.05 0   0 0 0   0 0 1"  # at the floor, which is a patch about the origin
LEVEL = "LookAt 0 0 -1   0 0 0   0 1 0"  # at something in the origin, along z
ACROSS = "LookAt 0 0.05 -0.05   0 0.05 0   0 1 0"  # at the small mirror, and so at the floor


def quad(*corners):
    points = "   ".join(" ".join("%g" % x for x in c) for c in corners)
    return 'Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ]\n    "point3 P" [ %s ]\n' % points


def metal(eta, k):
    spectra = " ".join('"spectrum %s" [ 360 %g 830 %g ]' % (name, x, x) for name, x in (("eta", eta), ("k", k)))
    return 'Material "conductor" %s "float roughness" [ 0 ]\n' % spectra


def lamp(radiance, *corners):
    return (
        'AttributeBegin\n    AreaLightSource "diffuse" "rgb L" [ %g %g %g ]\n' % ((radiance,) * 3)
        + '    Material "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
        + quad(*corners)
        + "AttributeEnd\n"
    )


DIFFUSE = 'Material "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]\n'
FLOOR = DIFFUSE + quad((-0.02, 0, -0.02), (-0.02, 0, 0.02), (0.02, 0, 0.02), (0.02, 0, -0.02))
POINT = 'LightSource "point" "rgb I" [ 3 3 3 ] "point3 from" [ 1 2 0.5 ]\n'
TURN_UP = metal(0.2, 3.9) + quad((-0.3, -0.3, -0.3), (0.3, -0.3, -0.3), (0.3, 0.3, 0.3), (-0.3, 0.3, 0.3))
TURN_ON = metal(0.2, 3.9) + quad((-0.3, 1.7, -0.3), (0.3, 1.7, -0.3), (0.3, 2.3, 0.3), (-0.3, 2.3, 0.3))
TURN_DOWN = metal(0.2, 3.9) + quad((-0.003, 0.047, 0.003), (0.003, 0.047, 0.003), (0.003, 0.053, -0.003), (-0.003, 0.053, -0.003))
# A mirror without loss in the plane x = 1, and a lamp that shines on it alone: its image is a lamp at x = 1.75.
WALL_MIRROR = metal(0.001, 1000) + quad((1, 0, -2), (1, 3, -2), (1, 3, 2), (1, 0, 2))
TO_MIRROR = lamp(5, (0.25, 0.5, -0.5), (0.25, 1.5, -0.5), (0.25, 1.5, 0.5), (0.25, 0.5, 0.5))
IMAGE = "0.6/pi * 5 * polygon((1.75, 0.5, -0.5), (1.75, 1.5, -0.5), (1.75, 1.5, 0.5), (1.75, 0.5, 0.5), normal=(0, 1, 0))"
POINT_IMAGE = "0.6/pi * 3 * point(1.75, 1, 0)"
# The same with a point light, in a shade that hides it from the floor.
POINT_TO_MIRROR = (
    'LightSource "point" "rgb I" [ 3 3 3 ] "point3 from" [ 0.25 1 0 ]\n'
    'Material "diffuse" "rgb reflectance" [ 0 0 0 ]\n' + quad((0.2, 0.5, -1), (0.2, 0.5, 1), (0.2, 0.9, 1), (0.2, 0.9, -1))
    + quad((0.05, 0.3, -1), (0.05, 0.3, 1), (0.2, 0.9, 1), (0.2, 0.9, -1))
)

REFLECT = "fresnel_metal(cos(radians(45)), 0.2, 3.9)"
# Half the side of the wider window and floor, and the formulas there at the point (x, 0, z).
WIDE = 0.15
WIDE_FORMULAS = {
    "le": "2",
    "ldde": "0.5/pi * 0.5/(1 - 0.5) * (1 - cos(radians(60)))/2 * 40/2**2",
    "lde": "0.6/pi * 2 * polygon((-x, 1, -z), (2 - x, 1, -z), (2 - x, 1, 1 - z), (-x, 1, 1 - z))",
    "lsde": "0.6/pi * 5 * polygon((1.75 - x, 0.5, -0.5 - z), (1.75 - x, 1.5, -0.5 - z), (1.75 - x, 1.5, 0.5 - z), "
            "(1.75 - x, 0.5, 0.5 - z), normal=(0, 1, 0))",
    "lsde-point": "0.6/pi * 3 * point(1.75 - x, 1, -z)",
}


# For photons: half the side of the window, their radius, how many, and what is replaced besides the floor.
HIGH_MIRROR = [["LookAt 0 0.05 -0.05   0 0.05 0", "LookAt 0 0.6 -0.05   0 0.6 0"],
               ["-0.003 0.047 0.003   0.003 0.047 0.003   0.003 0.053 -0.003   -0.003 0.053 -0.003",
                "-0.04 0.56 0.04   0.04 0.56 0.04   0.04 0.64 -0.04   -0.04 0.64 -0.04"]]
PHOTONS = {"ldde": (WIDE, 0.02, 25000, []), "lsde": (0.1, 0.02, 50000, []), "lsde-point": (0.1, 0.02, 50000, []),
           "lsdse": (0.03, 0.05, 100000, HIGH_MIRROR), "lsdse-point": (0.03, 0.06, 300000, HIGH_MIRROR)}
WIDE_FORMULAS_IN_MIRROR = {"lsdse": "lsde", "lsdse-point": "lsde-point"}


def mean_over_window(formula, half=WIDE, n=40):
    places = [half * ((2 * i + 1) / n - 1) for i in range(n)]
    return sum(eval(formula, globals(), {"x": x, "z": z}) for x in places for z in places) / n**2


ALL = ["path", "naive", "distribution", "tracepath", "restir-di", "restir-gi", "restir-pt", "metropolis",
       "irradiance-cache", "path:manifold=2"]
SCENES = {
    # name: class, title, camera, world, formula, who finds it besides paths from the eye (none: those do not)
    "le": ("LE", "A lamp.", LEVEL, lamp(2, (-1, -1, 0), (-1, 1, 0), (1, 1, 0), (1, -1, 0)), "2", ["direct"]),
    "lde": ("LDE", "A diffuse patch under a lamp.", DOWN,
            FLOOR + lamp(2, (0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1)),
            "0.6/pi * 2 * polygon((0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1))", ["direct"]),
    "lse": ("LSE", "A lamp in a metal mirror.", LEVEL, TURN_UP + lamp(2, (-1, 2, -1), (1, 2, -1), (1, 2, 1), (-1, 2, 1)),
            "2 * " + REFLECT, ["direct"]),
    "lsse": ("LSSE", "A lamp in two metal mirrors.", LEVEL,
             TURN_UP + TURN_ON + lamp(2, (-1, 1, 3), (-1, 3, 3), (1, 3, 3), (1, 1, 3)), "2 * " + REFLECT + "**2", []),
    "ldse": ("LDSE", "A diffuse patch under a point light, in a mirror.", ACROSS, FLOOR + TURN_DOWN + POINT,
             REFLECT + " * 0.6/pi * 3 * point(1, 2, 0.5)", []),
    "ldde": ("LDD+E", "The dark part of a diffuse sphere that a spot lights in one place.",
             "LookAt 0 0 0   -1 0 0   0 1 0",
             'LightSource "spot" "rgb I" [ 40 40 40 ] "point3 from" [ 0 0 0 ] "point3 to" [ 1 0 0 ] '
             '"float coneangle" [ 60 ] "float conedeltaangle" [ 0 ]\n'
             'Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]\nShape "sphere" "float radius" [ 2 ]\n',
             "0.5/pi * 0.5/(1 - 0.5) * (1 - cos(radians(60)))/2 * 40/2**2", []),
    "lsde": ("LSDE", "A diffuse patch lit by a lamp through a mirror: a caustic.", DOWN, FLOOR + WALL_MIRROR + TO_MIRROR,
             IMAGE, []),
    "lsdse": ("LSDSE", "A caustic seen in a mirror.", ACROSS, FLOOR + TURN_DOWN + WALL_MIRROR + TO_MIRROR,
              REFLECT + " * " + IMAGE, []),
    "lsde-point": ("LSDE of delta lights", "A diffuse patch lit by a point light through a mirror: no path from the eye meets it.",
                   DOWN, FLOOR + WALL_MIRROR + POINT_TO_MIRROR, POINT_IMAGE, None),
    "lsdse-point": ("LSDSE of delta lights", "The same in a mirror.", ACROSS,
                    FLOOR + TURN_DOWN + WALL_MIRROR + POINT_TO_MIRROR, REFLECT + " * " + POINT_IMAGE, None),
}

if __name__ == "__main__":
    entries = []
    for name, (paths, title, camera, world, formula, more) in SCENES.items():
        with open(os.path.join(here, name + ".pbrt"), "w") as file:
            file.write(HEAD.format(title=title, name=name, camera=camera, world=world))
        entries.append({"scene": name + ".pbrt", "class": paths, "formula": formula,
                        "value": float("%.9g" % eval(formula)), "found_by": [] if more is None else ALL + more})
        if name in WIDE_FORMULAS:
            entries[-1]["found_by"].append("light")
            entries[-1]["wide"] = {"side": WIDE, "value": float("%.9g" % mean_over_window(WIDE_FORMULAS[name]))}
        if entries[-1]["found_by"]:  # by either of the two, and so by both together
            entries[-1]["found_by"].append("bdpt")
        if more is None:  # a light that no ray meets, behind one mirror
            entries[-1]["found_by"].append("path:manifold=2")
        entries[-1]["found_by"] += ["sppm", "photonmap", "vcm"]
        if name in PHOTONS:
            half, radius, photons, replacements = PHOTONS[name]
            seen = WIDE_FORMULAS_IN_MIRROR.get(name)
            formula = "%s * %s" % (REFLECT, WIDE_FORMULAS[seen]) if seen else WIDE_FORMULAS[name]
            entries[-1]["photons"] = {"window": half, "floor": WIDE, "radius": radius, "photons": photons,
                                      "replaced": replacements, "value": float("%.9g" % mean_over_window(formula, half))}
    with open(os.path.join(here, "expected.json"), "w") as file:
        json.dump(entries, file, indent=1)
        file.write("\n")
