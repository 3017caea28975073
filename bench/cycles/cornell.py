"""The Cornell box (public measured data, grey version, with a lamp that is a box), written twice: glTF for Cycles, pbrt for
Montelux. Both files hold the same triangles, materials, lamp and camera."""
import base64
import json
import math
import struct
import sys

WHITE, RED, GREEN = 0.736263, 0.155163, 0.298262
EMISSION = 6.0
FOV, EYE = 39.3077, (278.0, 273.0, -800.0)


def quad(a, b, c, d):
    return [a, b, c, a, c, d]


def box(corners, low, high):
    """Sides, top and bottom of an upright prism over four corners (x, z)."""
    bottom = [(x, low, z) for x, z in corners]
    top = [(x, high, z) for x, z in corners]
    faces = quad(*top) + quad(*bottom[::-1])
    for i in range(4):
        j = (i + 1) % 4
        faces += quad(bottom[i], bottom[j], top[j], top[i])
    return faces


SURFACES = [
    ("white", quad((552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2))
     + quad((556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0))
     + quad((549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2))
     + box([(130, 65), (82, 225), (240, 272), (290, 114)], 0, 165)
     + box([(423, 247), (265, 296), (314, 456), (472, 406)], 0, 330)),
    ("green", quad((0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2))),
    ("red", quad((552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0))),
    ("lamp", box([(213, 227), (213, 332), (343, 332), (343, 227)], 528.0, 538.0)),
]
COLORS = {"white": WHITE, "green": GREEN, "red": RED, "lamp": 0.0}


def write_pbrt(path, width):
    lines = ['Film "rgb" "integer xresolution" [ %d ] "integer yresolution" [ %d ]' % (width, width),
             'PixelFilter "box"', 'Sampler "zsobol" "integer pixelsamples" [ 64 ]', 'Integrator "path"',
             "Scale -1 1 1", "LookAt %g %g %g  278 273 0  0 1 0" % EYE,
             'Camera "perspective" "float fov" [ %g ]' % FOV, "WorldBegin"]
    for name, points in SURFACES:
        lines += ["AttributeBegin",
                  'Material "diffuse" "rgb reflectance" [ %g %g %g ]' % ((COLORS[name],) * 3)]
        if name == "lamp":
            lines.append('AreaLightSource "diffuse" "rgb L" [ %g %g %g ] "bool twosided" true' % ((EMISSION,) * 3))
        lines.append('Shape "trianglemesh" "point3 P" [ %s ] "integer indices" [ %s ]' % (
            " ".join("%g %g %g" % p for p in points), " ".join(map(str, range(len(points))))))
        lines.append("AttributeEnd")
    with open(path, "w") as f:
        f.write("\n".join(lines) + "\n")


def write_gltf(path):
    blob, views, accessors, meshes, materials, nodes = b"", [], [], [], [], []
    for name, points in SURFACES:
        data = b"".join(struct.pack("<3f", *p) for p in points)
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        blob += data
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(points), "type": "VEC3",
                          "min": [min(p[i] for p in points) for i in range(3)],
                          "max": [max(p[i] for p in points) for i in range(3)]})
        material = {"name": name, "doubleSided": True,
                    "pbrMetallicRoughness": {"baseColorFactor": [COLORS[name]] * 3 + [1], "metallicFactor": 0,
                                             "roughnessFactor": 1},
                    "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
        if name == "lamp":
            material["emissiveFactor"] = [1, 1, 1]
            material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": EMISSION}
        materials.append(material)
        meshes.append({"primitives": [{"attributes": {"POSITION": len(accessors) - 1},
                                       "material": len(materials) - 1}]})
        nodes.append({"mesh": len(meshes) - 1})
    # The camera looks along -z of its node: turned round the y axis to look along +z.
    nodes.append({"camera": 0, "translation": list(EYE), "rotation": [0, 1, 0, 0]})
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
            "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views,
            "buffers": [{"byteLength": len(blob),
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(blob).decode()}],
            "cameras": [{"type": "perspective",
                         "perspective": {"yfov": math.radians(FOV), "aspectRatio": 1, "znear": 1, "zfar": 10000}}],
            "extensionsUsed": ["KHR_materials_specular", "KHR_materials_emissive_strength"]}
    with open(path, "w") as f:
        json.dump(gltf, f)


if __name__ == "__main__":
    folder, width = sys.argv[1], int(sys.argv[2])
    write_pbrt(folder + "/cornell.pbrt", width)
    write_gltf(folder + "/cornell.gltf")
