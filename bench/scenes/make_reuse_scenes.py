#!/usr/bin/env python3
"""Scenes with many lights, for docs/reuse.md: the same bytes in every run.

usage: make_reuse_scenes.py FOLDER

building.pbrt four storeys with columns, screens and coffered ceilings, and 1280 lanterns of 8 triangles in the
              coffers: a place sees few of the 10,240 triangles, whose strengths go over two and a half decades
terrace.pbrt  320 lamps (spheres and panels) in shades, between columns under a pergola, and a sky with a small sun
gallery.pbrt  320 lamps (spheres and panels) in the coffers of a hall with 24 windows to that sky
slats.pbrt    two lamps behind slats, small, for a map of the bias of naive weights
pan-grey.pbrt, pan-colour.pbrt
              a camera that pans over 40 balls under 400 panels of very different power, all grey or of any colour
sky.pfm       that sky, in equal-area octahedral coordinates
"""
import array
import math
import os
import random
import struct
import sys


class Mesh:
    """Triangles that share a material, and emission where they have one."""

    def __init__(self):
        self.points, self.indices = [], []

    def polygon(self, corners):
        base = len(self.points)
        self.points += corners
        for i in range(1, len(corners) - 1):
            self.indices += [base, base + i, base + i + 1]

    def box(self, low, high):
        (x0, y0, z0), (x1, y1, z1) = low, high
        self.polygon([(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)])
        self.polygon([(x0, y1, z0), (x0, y1, z1), (x1, y1, z1), (x1, y1, z0)])
        self.polygon([(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)])
        self.polygon([(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)])
        self.polygon([(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)])
        self.polygon([(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)])

    def octahedron(self, c, r):
        base = len(self.points)
        for axis in range(3):
            for side in (-r, r):
                self.points.append(tuple(c[i] + (side if i == axis else 0) for i in range(3)))
        # Normals point outward.
        for x in (0, 1):
            for y in (2, 3):
                for z in (4, 5):
                    even = (x + y + z) % 2 == 0
                    self.indices += [base + x, base + (z if even else y), base + (y if even else z)]

    def text(self):
        points = "  ".join("%.5g %.5g %.5g" % p for p in self.points)
        indices = " ".join(map(str, self.indices))
        return 'Shape "trianglemesh" "integer indices" [ %s ]\n  "point3 P" [ %s ]\n' % (indices, points)


def material(text, mesh):
    return "AttributeBegin\nMaterial %s\n%sAttributeEnd\n" % (text, mesh.text())


def lamp(radiance, shape):
    colour = "%.4g %.4g %.4g" % tuple(radiance)
    return 'AttributeBegin\nAreaLightSource "diffuse" "rgb L" [ %s ]\n%sAttributeEnd\n' % (colour, shape)


def head(eye, target, fov):
    return """LookAt %s  %s  0 1 0
Camera "perspective" "float fov" [ %g ]
Film "rgb" "integer xresolution" [ 480 ] "integer yresolution" [ 270 ] "string filename" [ "out.exr" ]
PixelFilter "box"
Integrator "path" "integer maxdepth" [ 5 ]
WorldBegin
""" % (" ".join("%g" % v for v in eye), " ".join("%g" % v for v in target), fov)


SKY = 'AttributeBegin\nRotate -90 1 0 0\nLightSource "infinite" "string filename" [ "sky.pfm" ]\nAttributeEnd\n'

COLOURS = [(1.0, 0.75, 0.45), (1.0, 0.5, 0.2), (1.0, 0.85, 0.7), (0.4, 0.65, 1.0), (1.0, 0.3, 0.35), (0.5, 1.0, 0.6)]


def radiance(rng, decades, middle):
    strength = middle * 10 ** (decades * (rng.random() - 0.5))
    return [strength * c for c in rng.choice(COLOURS)]


def ball_or_panel(rng, number, place, light):
    x, y, z = place
    if number % 2:
        r = rng.uniform(0.02, 0.05)
        return lamp(light, 'Translate %.4f %.4f %.4f\nShape "sphere" "float radius" [ %.4f ]\n' % (x, y, z, r))
    s = rng.uniform(0.02, 0.06)
    panel = Mesh()
    panel.polygon([(x - s, y, z - s), (x + s, y, z - s), (x + s, y, z + s), (x - s, y, z + s)])
    return lamp(light, panel.text())


def building(rng):
    floor, walls, cloth, metal = Mesh(), Mesh(), Mesh(), Mesh()
    lamps = []
    storeys, height, side, cells, slab = 4, 6.0, 12.0, 16, 0.3
    step = 2 * side / cells
    for storey in range(storeys):
        y0 = (storey - 1) * height
        top = y0 + height - slab
        low = top - 0.9
        floor.polygon([(-side, y0, -side), (-side, y0, side), (side, y0, side), (side, y0, -side)])
        walls.polygon([(-side, top, -side), (side, top, -side), (side, top, side), (-side, top, side)])
        # Coffers: fins below the ceiling.
        for i in range(cells + 1):
            c = -side + i * step
            walls.box((c - 0.03, low, -side), (c + 0.03, top, side))
            walls.box((-side, low, c - 0.03), (side, top, c + 0.03))
        for x in (-side, side):
            walls.polygon([(x, y0, -side), (x, top, -side), (x, top, side), (x, y0, side)])
        walls.polygon([(-side, y0, side), (-side, top, side), (side, top, side), (side, y0, side)])
        walls.polygon([(-side, y0, -side), (side, y0, -side), (side, top, -side), (-side, top, -side)])
        for x in (-6, 0, 6):
            for z in (-6, 0, 6):
                walls.box((x - 0.35, y0, z - 0.35), (x + 0.35, low, z + 0.35))
        # Screens and things on the floor.
        for _ in range(9):
            x, z, w, h = rng.uniform(-10, 10), rng.uniform(-7, 11), rng.uniform(0.6, 1.6), rng.uniform(1.2, 2.6)
            if rng.random() < 0.5:
                cloth.box((x - w, y0, z - 0.04), (x + w, y0 + h, z + 0.04))
            else:
                cloth.box((x - 0.04, y0, z - w), (x + 0.04, y0 + h, z + w))
        for _ in range(14):
            x, z, r = rng.uniform(-10, 10), rng.uniform(-7, 11), rng.uniform(0.3, 0.7)
            metal.octahedron((x, y0 + r, z), r)
        for k in range(1280 // storeys):
            i, j = rng.randrange(cells), rng.randrange(cells)
            x, z = -side + (i + rng.uniform(0.2, 0.8)) * step, -side + (j + rng.uniform(0.2, 0.8)) * step
            lantern = Mesh()
            lantern.octahedron((x, top - rng.uniform(0.15, 0.5), z), rng.uniform(0.03, 0.07))
            lamps.append(lamp(radiance(rng, 2.5, 200), lantern.text()))
    return (head((-10, 4.3, -10.5), (1.5, -4, 2), 45)
            + material('"coateddiffuse" "rgb reflectance" [ 0.25 0.24 0.22 ] "float roughness" [ 0.2 ]', floor)
            + material('"diffuse" "rgb reflectance" [ 0.6 0.58 0.55 ]', walls)
            + material('"diffuse" "rgb reflectance" [ 0.5 0.3 0.25 ]', cloth)
            + material('"conductor" "float roughness" [ 0.2 ]', metal)
            + "".join(lamps))


def sky_pixel(x, y, size):
    """Radiance at a pixel of the equal-area octahedral square (Clarberg 2008), where z is up."""
    u, v = 2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1
    s = 1 - abs(u) - abs(v)
    r = 1 - abs(s)
    phi = ((abs(v) - abs(u)) / r + 1) * math.pi / 4 if r > 0 else math.pi / 4
    z = math.copysign(1 - r * r, s)
    side = r * math.sqrt(2 - r * r)
    d = (math.copysign(math.cos(phi), u) * side, math.copysign(math.sin(phi), v) * side, z)
    if z < 0:
        return (0.02, 0.018, 0.015)
    sun = (0.55, 0.62, 0.56)
    n = math.sqrt(sum(c * c for c in sun))
    cos = sum(a * b for a, b in zip(d, sun)) / n
    glow = math.exp(60 * (cos - 1))
    clouds = 1 + 0.6 * math.sin(7 * d[0] + 3 * d[1]) * math.sin(5 * d[1] - 4 * d[2])
    base = [(0.10 + 0.25 * (1 - z)) * clouds, (0.16 + 0.12 * (1 - z)) * clouds, 0.35 * clouds]
    light = [b + g * glow for b, g in zip(base, (1.6, 1.0, 0.5))]
    if cos > math.cos(math.radians(0.3)):
        light = [68000.0, 55000.0, 37000.0]
    return tuple(light)


def write_sky(path, size=1024):
    rows = []
    for y in range(size):
        row = array.array("f")
        for x in range(size):
            row.extend(sky_pixel(x, y, size))
        rows.append(row)
    with open(path, "wb") as f:
        f.write(b"PF\n%d %d\n-1.0\n" % (size, size))
        # The last row comes first.
        for row in reversed(rows):
            f.write(struct.pack("<%df" % len(row), *row))


def terrace(rng):
    floor, walls, beams, metal, shades = Mesh(), Mesh(), Mesh(), Mesh(), Mesh()
    lamps = []
    floor.polygon([(-30, 0, -30), (-30, 0, 30), (30, 0, 30), (30, 0, -30)])
    for i in range(9):
        for j in range(5):
            x, z = 2.5 * (i - 4), 3.2 * (j - 1)
            walls.box((x - 0.2, 0, z - 0.2), (x + 0.2, 3.2, z + 0.2))
            walls.box((x - 0.3, 0, z - 0.3), (x + 0.3, 0.25, z + 0.3))
    for i in range(46):
        x = -11.25 + 0.5 * i
        beams.box((x - 0.09, 3.2, -4.2), (x + 0.09, 3.45, 11))
    for j in range(5):
        z = 3.2 * (j - 1)
        beams.box((-11.5, 3.05, z - 0.12), (11.5, 3.2, z + 0.12))
    walls.box((-12, 0, 11), (12, 4.5, 11.3))
    for _ in range(60):
        x, z, r = rng.uniform(-11, 11), rng.uniform(-4, 10), rng.uniform(0.15, 0.45)
        metal.octahedron((x, r, z), r)
    # Lamps hang in shades that are open below: a place sees those that it is nearly under.
    for i in range(320):
        x, y, z = rng.uniform(-11, 11), rng.uniform(2.5, 2.9), rng.uniform(-4, 10.5)
        light = radiance(rng, 2, 60)
        w, low, high = 0.1, y - 0.08, y + 0.1
        shades.polygon([(x - w, high, z - w), (x + w, high, z - w), (x + w, high, z + w), (x - w, high, z + w)])
        for sx, sz in (1, 0), (-1, 0), (0, 1), (0, -1):
            a = (x + sx * w - sz * w, z + sz * w + sx * w)
            b = (x + sx * w + sz * w, z + sz * w - sx * w)
            shades.polygon([(a[0], low, a[1]), (b[0], low, b[1]), (b[0], high, b[1]), (a[0], high, a[1])])
        lamps.append(ball_or_panel(rng, i, (x, y, z), light))
    return (head((-8, 2.45, -3), (0.3, -1.75, 2.5), 45)
            + SKY
            + material('"coateddiffuse" "rgb reflectance" [ 0.4 0.38 0.35 ] "float roughness" [ 0.25 ]', floor)
            + material('"diffuse" "rgb reflectance" [ 0.6 0.56 0.5 ]', walls)
            + material('"diffuse" "rgb reflectance" [ 0.35 0.22 0.14 ]', beams)
            + material('"diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]', shades)
            + material('"conductor" "float roughness" [ 0.25 ]', metal)
            + "".join(lamps))


def gallery(rng):
    floor, walls, cloth, metal = Mesh(), Mesh(), Mesh(), Mesh()
    lamps = []
    side, top, cells = 12.0, 5.7, 16
    step, low = 2 * side / cells, top - 0.6
    floor.polygon([(-30, 0, -30), (-30, 0, 30), (30, 0, 30), (30, 0, -30)])
    walls.box((-side - 0.4, top, -side - 0.4), (side + 0.4, top + 0.3, side + 0.4))
    for i in range(cells + 1):
        c = -side + i * step
        walls.box((c - 0.03, low, -side), (c + 0.03, top, side))
        walls.box((-side, low, c - 0.03), (side, top, c + 0.03))
    # Walls with six windows each: a sill, a lintel, piers.
    for sign in (-1, 1):
        inner, outer = sorted((sign * side, sign * (side + 0.4)))
        for y0, y1 in (0, 0.9), (4.2, top):
            walls.box((inner, y0, -side), (outer, y1, side))
            walls.box((-side, y0, inner), (side, y1, outer))
        for k in range(7):
            c = -side + 4 * k
            walls.box((inner, 0.9, c - 1.1), (outer, 4.2, c + 1.1))
            walls.box((c - 1.1, 0.9, inner), (c + 1.1, 4.2, outer))
    for x in (-6, 0, 6):
        for z in (-6, 0, 6):
            walls.box((x - 0.35, 0, z - 0.35), (x + 0.35, low, z + 0.35))
    for _ in range(12):
        x, z, w, h = rng.uniform(-9, 10), rng.uniform(-6, 11), rng.uniform(0.6, 1.6), rng.uniform(1.2, 2.6)
        if rng.random() < 0.5:
            cloth.box((x - w, 0, z - 0.04), (x + w, h, z + 0.04))
        else:
            cloth.box((x - 0.04, 0, z - w), (x + 0.04, h, z + w))
    for _ in range(40):
        x, z, r = rng.uniform(-10, 11), rng.uniform(-7, 11), rng.uniform(0.2, 0.6)
        metal.octahedron((x, r, z), r)
    for i in range(320):
        x, z = (-side + (rng.randrange(cells) + rng.uniform(0.2, 0.8)) * step for _ in range(2))
        y, light = top - rng.uniform(0.15, 0.4), radiance(rng, 2, 60)
        lamps.append(ball_or_panel(rng, i, (x, y, z), light))
    # The picture has neither windows nor lamps in it: their edges are noise that no way to sample light changes.
    return (head((-10, 4.3, -10.5), (1.5, -7, 2), 45)
            + SKY
            + material('"coateddiffuse" "rgb reflectance" [ 0.4 0.38 0.35 ] "float roughness" [ 0.25 ]', floor)
            + material('"diffuse" "rgb reflectance" [ 0.6 0.58 0.55 ]', walls)
            + material('"diffuse" "rgb reflectance" [ 0.5 0.3 0.25 ]', cloth)
            + material('"conductor" "float roughness" [ 0.25 ]', metal)
            + "".join(lamps))


def slats(_):
    grey, floor = Mesh(), Mesh()
    floor.polygon([(-3, 0, -3), (-3, 0, 3), (3, 0, 3), (3, 0, -3)])
    for i in range(6):
        x = -2 + 0.7 * i
        grey.polygon([(x, 0.7, -2), (x + 0.4, 0.7, -2), (x + 0.4, 0.7, 2), (x, 0.7, 2)])
    lamps = ""
    for x, z, light in (-1.2, 0.0, (12, 10, 8)), (1.2, 0.4, (4, 6, 12)):
        panel = Mesh()
        panel.polygon([(x - 0.3, 2.3, z - 0.3), (x + 0.3, 2.3, z - 0.3), (x + 0.3, 2.3, z + 0.3), (x - 0.3, 2.3, z + 0.3)])
        lamps += lamp(light, panel.text())
    top = head((0, 1.6, -4), (0, 0.6, 0), 45).replace("480", "96").replace("270", "96").replace("[ 5 ]", "[ 1 ]")
    return top + material('"diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]', floor) + material('"diffuse" "rgb reflectance" [ 0.3 0.4 0.6 ]', grey) + lamps


def pan(rng, coloured):
    floor = Mesh()
    floor.polygon([(-8, 0, -8), (-8, 0, 8), (8, 0, 8), (8, 0, -8)])
    balls = "".join("AttributeBegin\nTranslate %.4g %.4g %.4g\nShape \"sphere\" \"float radius\" [ %.4g ]\nAttributeEnd\n"
                    % (rng.uniform(-4, 4), r, rng.uniform(-3, 4), r) for r in (rng.uniform(0.2, 0.5) for _ in range(40)))
    lamps = 'Material "diffuse" "rgb reflectance" [ 0 0 0 ]\n'
    for _ in range(400):
        light = radiance(rng, 2.5, 15)
        if not coloured:
            light = [sum(light) / 3] * 3
        place = rng.uniform(-5, 5), rng.uniform(1.2, 3), rng.uniform(-4, 5)
        lamps += ball_or_panel(rng, 0, place, light)
    # From above: panels shine down, and no edge of a lamp is in the picture, whose noise no history changes.
    looks = ["LookAt %g 7 -4  %g 0 0.3  0 1 0" % (x, x) for x in (-0.9, 0.9)]
    top = head((0, 0, 0), (0, 0, 1), 45).replace("480", "160").replace("270", "90").replace("[ 5 ]", "[ 1 ]")
    camera = "ActiveTransform StartTime\n%s\nActiveTransform EndTime\n%s\nActiveTransform All\n" % tuple(looks)
    return (camera + top[top.index("Camera"):] + material('"diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]', floor)
            + 'AttributeBegin\nMaterial "diffuse" "rgb reflectance" [ 0.6 0.6 0.6 ]\n' + balls + "AttributeEnd\n" + lamps)


def main():
    folder = sys.argv[1]
    os.makedirs(folder, exist_ok=True)
    makers = {"building": building, "terrace": terrace, "gallery": gallery, "slats": slats,
              "pan-grey": lambda rng: pan(rng, False), "pan-colour": lambda rng: pan(rng, True)}
    for name, make in makers.items():
        with open(os.path.join(folder, name + ".pbrt"), "w") as f:
            f.write(make(random.Random(name)))
    write_sky(os.path.join(folder, "sky.pfm"))


main()
