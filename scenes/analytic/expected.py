#!/usr/bin/env python3
"""Writes expected.json: the mean that each scene of this folder has in theory.

Every formula is evaluated here as it stands in the file, with the functions below and nothing of Montelux. `fault` is a
change of the scene's text that must be detected: a test renders the changed scene too.
"""
import json
import math
import os
from math import cos, pi, radians, sin, sqrt


def fresnel(cos_i, eta):
    """Unpolarised reflectance of a dielectric; eta: inside over outside; cos_i on the outside."""
    sin2_t = (1 - cos_i * cos_i) / (eta * eta)
    if sin2_t >= 1:
        return 1.0
    cos_t = sqrt(1 - sin2_t)
    s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t)
    p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t)
    return (s * s + p * p) / 2


def fresnel_metal(cos_i, eta, k):
    n = complex(eta, k)
    cos_t = (1 - (1 - cos_i * cos_i) / (n * n)) ** 0.5
    s = (cos_i - n * cos_t) / (cos_i + n * cos_t)
    p = (n * cos_i - cos_t) / (n * cos_i + cos_t)
    return (abs(s) ** 2 + abs(p) ** 2) / 2


def diffuse_fresnel(eta, n=200000):
    """Reflectance of a dielectric for diffuse light from outside: the integral of 2 cos F(cos) d cos."""
    return sum(2 * (i + 0.5) / n * fresnel((i + 0.5) / n, eta) for i in range(n)) / n


def coated(albedo, eta, cos_o):
    """Radiance of a diffuse base under a smooth clear coat in a uniform sky of radiance 1 (Saunderson 1942)."""
    outside = diffuse_fresnel(eta)
    inside = 1 - (1 - outside) / eta**2
    base = albedo * (1 - outside) / (1 - albedo * inside)
    r = fresnel(cos_o, eta)
    return r + (1 - r) * base / eta**2


def pane(reflectance):
    """Transmittance of two interfaces with all reflections between them."""
    return (1 - reflectance) / (1 + reflectance)


def ggx_albedo(alpha, cos_o, eta, k, n=1200):
    """Directional albedo of a GGX metal: visible half vectors, height-correlated masking (Heitz 2014), midpoints."""
    o = (sqrt(1 - cos_o * cos_o), 0.0, cos_o)

    def smith(c):
        return (sqrt(1 + alpha**2 * (1 - c * c) / (c * c)) - 1) / 2

    total = 0.0
    for i in range(n):
        u = (i + 0.5) / n
        tan2 = alpha**2 * u / (1 - u)
        cos_h = 1 / sqrt(1 + tan2)
        sin_h = sqrt(1 - cos_h**2)
        for j in range(n // 4):
            a = pi * (j + 0.5) / (n // 4)
            d = o[0] * sin_h * cos(a) + o[2] * cos_h
            i_z = 2 * d * cos_h - o[2]
            if d > 0 and i_z > 0:
                g = 1 / (1 + smith(cos_o) + smith(i_z))
                total += fresnel_metal(d, eta, k) * g * d / (cos_h * cos_o)
    return total / (n * (n // 4))


def polygon(*corners, normal=(0, 1, 0)):
    """Irradiance at the origin by a polygon of radiance 1 that is wholly above the horizon (Lambert 1760)."""
    unit = [[x / sqrt(sum(y * y for y in c)) for x in c] for c in corners]
    total = 0.0
    for a, b in zip(unit, unit[1:] + unit[:1]):
        cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        sine = sqrt(sum(x * x for x in cross))
        angle = math.atan2(sine, sum(x * y for x, y in zip(a, b)))
        total += angle * sum(x * y for x, y in zip(cross, normal)) / sine
    return abs(total) / 2


def sphere(radius, *centre):
    """Irradiance at the origin of the plane y = 0 by a sphere of radiance 1 above it."""
    d2 = sum(x * x for x in centre)
    return pi * radius**2 / d2 * centre[1] / sqrt(d2)


def disk(radius, height, aside):
    """Irradiance by a level disk of radiance 1 (Siegel and Howell, configuration B-13)."""
    s = height**2 + aside**2
    return pi / 2 * (1 - (s - radius**2) / sqrt((s + radius**2) ** 2 - 4 * aside**2 * radius**2))


def point(*p, normal=(0, 1, 0)):
    """Irradiance at the origin by a point light of intensity 1."""
    d2 = sum(x * x for x in p)
    return sum(x * y for x, y in zip(p, normal)) / d2**1.5


def smooth_step(x, low, high):
    t = min(max((x - low) / (high - low), 0), 1)
    return t * t * (3 - 2 * t)


def facing_squares():
    """Form factor of two unit squares at distance 1 (Siegel and Howell, configuration C-11)."""
    return 2 / pi * (math.log(sqrt(4 / 3)) + 2 * sqrt(2) * math.atan(1 / sqrt(2)) - 2 * math.atan(1))


def corner_squares():
    """Form factor of two unit squares with a common edge at a right angle (configuration C-14)."""
    return (2 * math.atan(1) - sqrt(2) * math.atan(1 / sqrt(2)) + math.log(3 / 4) / 4) / pi


WHITE = "1"
PLATE_POINT = "0.6/pi * 3 * point(1, 2, 0.5)"
SCENES = {
    # name: formula, (a text of the scene, what the fault puts in its place)
    "furnace-diffuse": (WHITE, ("[ 1 1 1 ]\nShape", "[ 0.99 0.99 0.99 ]\nShape")),
    "furnace-mirror-glass": (WHITE, ("[ 1 1 1 ]\nMaterial", "[ 0.99 0.99 0.99 ]\nMaterial")),
    "furnace-thin-glass": (WHITE, ("[ 1 1 1 ]\nMaterial", "[ 0.99 0.99 0.99 ]\nMaterial")),
    "furnace-transmission": (WHITE, ("0.9 0.9 0.9", "0.88 0.88 0.88")),
    "furnace-interface": (WHITE, ('"interface"', '"thindielectric" "float eta" [ 1.5 ]\nMaterial "diffuse"')),
    "shining-interface": ("0.6 * (1 + 0.5)", ("0.5 0.5 0.5", "0.55 0.55 0.55")),
    "furnace-coated-eta1": (WHITE, ('reflectance" [ 1 1 1', 'reflectance" [ 0.99 0.99 0.99')),
    "furnace-coated": (WHITE, ('"integer maxdepth" [ 10000 ]', '"integer maxdepth" [ 4 ]')),
    "furnace-phong": ("0.4 + 0.35", ('ks" [ 0.35 0.35 0.35', 'ks" [ 0.36 0.36 0.36')),
    "half-open-sheets": ("0.9 ** 2", ("[ 0.9 ]", "[ 0.92 ]")),
    "furnace-mix": ("3/4 * 0.9 + 1/4 * 0.5", ("[ 0.25 ]", "[ 0.35 ]")),
    "mirror-normal": ("0.5", ("0.5 0.5 0.5", "0.505 0.505 0.505")),
    "metal-60": ("fresnel_metal(cos(radians(60)), 0.2, 3.9)", ("3.9 830 3.9", "3.8 830 3.8")),
    "rough-metal-45": ("ggx_albedo(0.3, cos(radians(45)), 0.2, 3.9)", ("[ 0.3 ]", "[ 0.4 ]")),
    "coated-plate-45": ("coated(0.5, 1.5, cos(radians(45)))", ("0.5 0.5 0.5", "0.51 0.51 0.51")),
    "glass-slab-normal": ("pane(fresnel(1, 1.5))", ("[ 1.5 ]", "[ 1.55 ]")),
    "glass-slab-60": ("pane(fresnel(cos(radians(60)), 1.5))", ("[ 1.5 ]", "[ 1.55 ]")),
    "thin-pane-60": ("pane(fresnel(cos(radians(60)), 1.5))", ("[ 1.5 ]", "[ 1.55 ]")),
    "translucent-sheet": ("0.5/pi * 3 * point(1, 2, 0)", ("0.5 0.5 0.5", "0.505 0.505 0.505")),
    "closed-furnace-sphere": ("0.5 / (1 - 0.6)", ("0.6 0.6 0.6", "0.61 0.61 0.61")),
    "closed-furnace-box": ("0.6 / (1 - 0.5)", ("0.5 0.5 0.5", "0.51 0.51 0.51")),
    "closed-furnace-depth-0": ("0.5", ('"integer maxdepth" [ 0 ]', '"integer maxdepth" [ 1 ]')),
    "closed-furnace-depth-1": ("0.5 * (1 + 0.7)", ('"integer maxdepth" [ 1 ]', '"integer maxdepth" [ 2 ]')),
    "closed-furnace-depth-3": ("0.5 * (1 + 0.7 + 0.7**2 + 0.7**3)", ("0.7 0.7 0.7", "0.705 0.705 0.705")),
    "integrating-sphere": ("0.5/pi * 1/2**2 / (1 - 0.5)", ("0.5 0.5 0.5", "0.51 0.51 0.51")),
    "two-cap-sphere": ("1/4 * 2 / (1 - 1/4 * 0.3 - 3/4 * 0.6)", ("0.6 0.6 0.6", "0.62 0.62 0.62")),
    "rectangle-light": ("0.6/pi * 2 * polygon((0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1))", ("[ 2 2 2 ]", "[ 2.02 2.02 2.02 ]")),
    "rectangle-light-near": ("0.6/pi * 2 * polygon((-1, 0.2, -1), (1, 0.2, -1), (1, 0.2, 1), (-1, 0.2, 1))", ("[ 2 2 2 ]", "[ 2.02 2.02 2.02 ]")),
    "rectangle-light-far-off": ("0.6/pi * 2 * polygon((0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1))", ("[ 2 2 2 ]", "[ 2.02 2.02 2.02 ]")),
    "rectangle-light-tilted": ("0.6/pi * 4 * polygon((1, 0.5, -1), (2, 1.5, -1), (2, 1.5, 1), (1, 0.5, 1))", ("2 1.5 1 ]", "2 1.55 1.05 ]")),
    "triangle-light": ("0.6/pi * 4 * polygon((0.5, 0.4, -0.3), (1.5, 0.9, 0.2), (0.2, 1.2, 0.8))", ("0.2 1.2 0.8", "0.2 1.22 0.82")),
    "triangle-light-far": ("0.6/pi * 400 * polygon((0.1, 8, 0), (0.4, 8.1, 0), (0.2, 8, 0.3))", ("0.2 8 0.3", "0.2 8 0.304")),
    "one-sided-light": ("0.6/pi * 2 * polygon((-1, 1, -1), (1, 1, -1), (1, 1, 1), (-1, 1, 1))", ("[ 7 7 7 ]", '[ 7 7 7 ] "bool twosided" [ true ]')),
    "sphere-light": ("0.6/pi * 5 * sphere(0.5, 1, 2, 0)", ("[ 0.5 ]", "[ 0.505 ]")),
    "sphere-light-inside": ("0.6/pi * 5 * sphere(0.5, 1, 2, 0)", ("[ 0.5 ]", "[ 0.51 ]")),
    "sphere-light-near": ("0.6/pi * 2 * sphere(1, 0, 1.1, 0)", ("[ 1 ]", "[ 1.01 ]")),
    "disk-light-axis": ("0.6/pi * 3 * disk(0.7, 1, 0)", ("[ 0.7 ]", "[ 0.71 ]")),
    "disk-light-aside": ("0.6/pi * 3 * disk(0.7, 1, 1.5)", ("[ 0.7 ]", "[ 0.71 ]")),
    "cylinder-around": ("0.6 * 3 * 1.5**2 / (1.5**2 + 1)", ('zmax" [ 1.5 ]', 'zmax" [ 1.55 ]')),
    "point-light": (PLATE_POINT, ("[ 3 3 3 ]", "[ 3.03 3.03 3.03 ]")),
    "point-light-power": ("0.6/pi * 40/(4*pi) * point(1, 2, 0.5)", ("[ 40 ]", "[ 40.4 ]")),
    "distant-light": ("0.6/pi * 4 * cos(radians(60))", ("1.7320508 1 0", "1.72 1 0")),
    "spot-light-core": ("0.6/pi * 3 * point(1, 2, 0)", ("0.2 0 0", "1.2 0 0")),
    "spot-light-edge": ("0.6/pi * 3 * point(1, 2, 0) * smooth_step(2/sqrt(5), cos(radians(30)), cos(radians(20)))", ("[ 30 ]", "[ 30.2 ]")),
    "goniometric-light": ("0.6/pi * 3 * point(0, 2, 0) / 2", ("Translate 0 2 0", "Translate 0.0001 2 0")),
    "projection-light": ("0.6/pi * 3 * point(0, 2, 0) / 2", ("Translate 0 2 0", "Translate 0.0001 2 0")),
    "many-point-lights": ("0.6/pi * sum((0.2 + 0.1 * ((3*i + j) % 5)) * point(i, 1 + (i*i + j) % 3, j) for i in range(-2, 3) for j in range(-2, 3))", ("[ 2 1 2 ]", "[ 2 9 2 ]")),
    "kinds-of-lights": ("0.6/pi * (pi*0.3 + cos(radians(45)) + 2*point(0, 3, -2) + (3 - 0.3)*sphere(0.5, 1, 2, 1) + (4 - 0.3)*polygon((-3, 0.5, 1), (-2, 1, 1), (-2, 1, 3), (-3, 0.5, 3)))", ("[ 0.3 0.3 0.3 ]", "[ 0.31 0.31 0.31 ]")),
    "sky": ("0.6 * 2", ("[ 2 2 2 ]", "[ 2.02 2.02 2.02 ]")),
    "sky-checkerboard": ("(0.8 + 0.1)/2 * 2", ("0.8 0.8 0.8", "0.81 0.81 0.81")),
    "sky-two-tone": ("0.6 * (1 + 3)/2", ('scale" [ 2 ]', 'scale" [ 2.1 ]')),
    "sky-two-tone-tilted": ("0.6 * (1 + 2 * (1 + sin(radians(30)))/2)", ("-30 0 0 1", "-28 0 0 1")),
    "sky-behind-ball": ("0.6 * 2 * (1 - sphere(1, 0.5, 1.5, 0)/pi)", ("Translate 0.5", "Translate 0.6")),
    "facing-squares": ("0.6 * facing_squares()", ("[ 1 1 1 ]", "[ 1.01 1.01 1.01 ]")),
    "corner-squares": ("0.6 * corner_squares()", ("0.6 0.6 0.6", "0.606 0.606 0.606")),
    "depth-of-field": ("2 * 3**2 / (2 * 5 * 0.5)**2", ("[ 53.130102 ]", "[ 53.5 ]")),
    "filter-box": ("1.7", ("1.7 1.7 1.7", "1.71 1.71 1.71")),
    "filter-triangle": ("1.7", ("1.7 1.7 1.7", "1.71 1.71 1.71")),
    "filter-gaussian": ("1.7", ("1.7 1.7 1.7", "1.71 1.71 1.71")),
    "filter-mitchell": ("1.7", ("1.7 1.7 1.7", "1.75 1.75 1.75")),
    "filter-sinc": ("1.7", ("1.7 1.7 1.7", "1.8 1.8 1.8")),
    "alpha-sky": ("1 - 0.2", ("[ 0.2 ]", "[ 0.22 ]")),
    "alpha-shadow": ("0.6/pi * 3 * point(1, 2, 0.5) * (1 - 0.2)", ("[ 0.2 ]", "[ 0.22 ]")),
    "half-open-ball": (PLATE_POINT + " * (1 - 0.4/2)**2", ("[ 0.4 ]", "[ 0.44 ]")),
    "mixed-sheet-in-place": (PLATE_POINT, ("Translate 0 1 0", "Translate 0 0.5 0")),
    "mixed-sheet-shadow": ("0.6/pi * 2 * polygon((0, 1, 0), (2, 1, 0), (2, 1, 1), (0, 1, 1)) * (1 - (1/2)**2)", ('"half" ] "float amount" [ 0.5 ]', '"half" ] "float amount" [ 0.6 ]')),
    "instance-plane": ("0.6/pi * 3 * point(1, 2, 0.5, normal=(1/sqrt(5), 2/sqrt(5), 0))", ("Scale -4 2 3", "Scale 4 2 3")),
    "instance-shadow": (PLATE_POINT, ("Scale 0.3 0.3 -0.3", "Scale 0.3 0.3 -0.3\n    Translate 0 1.5 0")),
    "motion-edge": ("2 * (1 - (2.5 - 1)/2 * (2.5 - 1)/(3 - 1)/2)", ("TransformTimes 1 3", "TransformTimes 1 3.1")),
    "motion-rotation": ("1 - 0.8 * 2/pi", ("Rotate 90 0", "Rotate 88 0")),
    "motion-scale": ("1 - pi/16 * (1 + 1/4 + 1/16)/3", ("Scale 0.25 0.25", "Scale 0.35 0.35")),
    "motion-within": ("1 - 1/2", ("Translate -1 0 0\n    ActiveTransform All\n    Shape", "Translate -1.1 0 0\n    ActiveTransform All\n    Shape")),
    "motion-camera": ("1 - (1/4 + 3/4)/2", ("LookAt 1 0 -5   1 0 0", "LookAt 1.1 0 -5   1.1 0 0")),
    "motion-shadow": ("0.6/pi * (3 * point(1, 2, 0.5) + 5 * 3/5 * point(-2, 2, 0))", ("Translate -1.2", "Translate -1.3")),
    "motion-deform": ("1 - (0.4 + 2*1.2 + 1.6)/4 / 2", ("0.2 -1 0   0.2 1 0", "0.23 -1 0   0.23 1 0")),
    "motion-furnace": (WHITE, ("reflectance\" [ 1 1 1 ]", "reflectance\" [ 0.97 0.97 0.97 ]")),
    "aperture-triangle": ("2 * 4/9", ('blades" [ 3 ]', 'blades" [ 4 ]')),
    "aperture-hexagon": ("2 * 1/6", ("[ 90 ]", "[ 75 ]")),
}

if __name__ == "__main__":
    folder = os.path.dirname(os.path.abspath(__file__))
    entries = [
        {"scene": name + ".pbrt", "formula": formula, "value": float("%.9g" % eval(formula)),
         "fault": {"replace": fault[0], "by": fault[1]}}
        for name, (formula, fault) in SCENES.items()
    ]
    with open(os.path.join(folder, "expected.json"), "w") as file:
        json.dump(entries, file, indent=1)
        file.write("\n")
