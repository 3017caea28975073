#!/usr/bin/env bash
# Time to load a scene of a million triangles (a binary PLY mesh): reading, preparing, building.
# usage: bench/load_bench.sh [path of montelux]
set -euo pipefail
montelux=${1:-build/release/montelux}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 - "$folder" <<'PYTHON'
import array, math, struct, sys
side = 708  # 2 (side - 1)^2 triangles
folder = sys.argv[1]
with open(folder + "/mesh.ply", "wb") as f:
    n = side - 1
    f.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
             "element face %d\nproperty list uchar int vertex_indices\nend_header\n" % (side * side, 2 * n * n)).encode())
    v = array.array("f")
    for j in range(side):
        for i in range(side):
            x, y = i / n - 0.5, j / n - 0.5
            v.extend((x, y, 0.05 * math.sin(40 * x) * math.cos(30 * y)))
    f.write(v.tobytes())
    faces = bytearray()
    for j in range(n):
        for i in range(n):
            a = j * side + i
            faces += struct.pack("<B3iB3i", 3, a, a + 1, a + side, 3, a + 1, a + side + 1, a + side)
    f.write(faces)
with open(folder + "/scene.pbrt", "w") as f:
    f.write('LookAt 0 -1 1  0 0 0  0 0 1\nCamera "perspective" "float fov" [ 50 ]\n'
            'Film "rgb" "integer xresolution" [ 64 ] "integer yresolution" [ 64 ]\nWorldBegin\n'
            'LightSource "infinite" "rgb L" [ 1 1 1 ]\nShape "plymesh" "string filename" "mesh.ply"\n')
PYTHON
for round in 1 2 3; do "$montelux" info "$folder/scene.pbrt"; done
