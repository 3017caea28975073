"""tools/check_layers finds each kind of planted fault, where it is, and nothing in a tree without fault."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_layers"


class Tree(unittest.TestCase):
    """A small source tree in a temporary folder; each test plants one fault."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.write("src/math/vec.h", "#pragma once\n#include <cmath>\nstruct Vec {};\n")
        self.write("src/mc/density.h", '#pragma once\n#include "math/vec.h"\nstruct Density { Vec v; };\n')
        self.write("src/scene/scene.h", '#pragma once\n#include "mc/density.h"\nstruct Scene {};\n')
        self.write("src/phase/phase.h", '#pragma once\n#include "mc/density.h"\n')
        self.write("src/medium/medium.h", '#pragma once\n#include "phase/phase.h"\n')
        self.write("src/api/render.h", '#pragma once\n#include "scene/scene.h"\n')
        self.write("apps/montelux/main.cpp", '#include "api/render.h"\n#include <CLI/CLI.hpp>\nint main() {}\n')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_tool(self, *arguments):
        return subprocess.run([sys.executable, str(TOOL), "--root", str(self.root), *arguments],
                              capture_output=True, text=True, check=False)

    def assert_clean(self, *arguments):
        result = self.run_tool(*arguments)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def assert_found(self, place, *arguments):
        result = self.run_tool(*arguments)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(place, result.stdout)

    def test_a_tree_without_fault_passes(self):
        self.assert_clean()
        self.assert_clean("--headers")

    def test_a_lower_layer_may_not_include_a_higher_one(self):
        self.write("src/math/bad.h", '#pragma once\n\n#include "mc/density.h"\n')
        self.assert_found("src/math/bad.h:3: math may not include mc")

    def test_siblings_do_not_see_each_other(self):
        self.write("src/material/lambert.h", "#pragma once\n")
        self.write("src/light/area.cpp", '#include "material/lambert.h"\n')
        self.assert_found("src/light/area.cpp:1: light may not include material")

    def test_phase_does_not_see_medium(self):
        self.write("src/phase/bad.cpp", '#include "medium/medium.h"\n')
        self.assert_found("src/phase/bad.cpp:1:")

    def test_film_never_sees_scene(self):
        self.write("src/film/film.h", '#pragma once\n#include "scene/scene.h"\n')
        self.assert_found("src/film/film.h:2:")

    def test_an_integrator_knows_neither_film_nor_threads(self):
        self.write("src/film/film.h", "#pragma once\n")
        self.write("src/integrator/path/tracer.cpp", '#include "film/film.h"\n#include <thread>\n')
        self.assert_found("src/integrator/path/tracer.cpp:1: integrator may not include film")
        self.assert_found("src/integrator/path/tracer.cpp:2: an integrator knows no threads")

    def test_the_program_sees_the_interface_alone(self):
        self.write("apps/montelux/info.cpp", '#include "scene/scene.h"\n')
        self.assert_found("apps/montelux/info.cpp:1: apps may not include scene")

    def test_an_include_in_a_comment_does_not_count(self):
        self.write("src/math/fine.h", '#pragma once\n// #include "mc/density.h"\n/*\n#include "scene/scene.h"\n*/\n')
        self.assert_clean()

    def test_a_line_after_a_long_comment_keeps_its_number(self):
        self.write("src/math/bad.h", '/* one\n two */\n#include "mc/density.h"\n')
        self.assert_found("src/math/bad.h:3:")

    def test_an_unknown_folder_is_an_error(self):
        self.write("src/misc/misc.h", "#pragma once\n")
        self.assert_found("src/misc/misc.h:1: folder src/misc is in no layer")

    def test_an_include_that_does_not_exist_is_an_error(self):
        self.write("src/mc/bad.h", '#pragma once\n#include "math/none.h"\n')
        self.assert_found('src/mc/bad.h:2: no such header: "math/none.h"')

    def test_an_include_relative_to_its_folder_is_an_error(self):
        self.write("src/mc/bad.h", '#pragma once\n#include "density.h"\n')
        self.assert_found("src/mc/bad.h:2:")

    def test_mc_may_not_speak_of_optics(self):
        self.write("src/mc/bad.h", "#pragma once\nint a;\nint sample_light(int u);\n")
        self.assert_found("src/mc/bad.h:3: mc knows no word of optics (sample_light)")
        self.write("src/mc/bad.h", "#pragma once\nstruct BsdfSample {};\n")
        self.assert_found("src/mc/bad.h:2:")

    def test_words_of_optics_in_comments_literals_and_longer_words_pass(self):
        self.write("src/mc/fine.h", '#pragma once\n// light\ninline const char* text() { return "scene"; }\n'
                                    "int pixel; int highlight; int slight_of;\n")
        self.assert_clean()

    def test_embree_stays_in_accel_and_image_files_in_image(self):
        self.write("src/scene/bad.cpp", "#include <embree3/rtcore.h>\n")
        self.assert_found("src/scene/bad.cpp:1: Embree")
        self.write("src/scene/bad.cpp", "#include <OpenImageIO/imageio.h>\n")
        self.assert_found("src/scene/bad.cpp:1: OpenImageIO")
        self.write("src/scene/bad.cpp", "")
        self.write("src/accel/accel.h", "#pragma once\n#include <embree3/rtcore.h>\n")
        self.assert_clean()

    def test_a_third_party_header_in_a_header_is_an_error(self):
        self.write("src/io/json.h", "#pragma once\n#include <nlohmann/json.hpp>\n")
        self.assert_found("src/io/json.h:2: third-party header in a header")

    def test_standard_and_system_headers_are_no_third_party(self):
        self.write("src/io/fine.h", "#pragma once\n#include <vector>\n#include <sys/stat.h>\n#include <unistd.h>\n")
        self.assert_clean()

    def test_file_sizes_warn_and_fail(self):
        self.write("src/math/long.h", "#pragma once\n" + "\n" * 450)
        self.assertIn("warning: 451 lines", self.assert_clean())
        self.write("src/math/long.h", "#pragma once\n" + "\n" * 850)
        self.assert_found("src/math/long.h:851:")

    def test_a_header_that_leans_on_another_does_not_compile_alone(self):
        self.write("src/mc/leaning.h", "#pragma once\nstruct Leaning { Vec v; };\n")
        self.assert_found("src/mc/leaning.h:1: does not compile alone", "--headers")


if __name__ == "__main__":
    unittest.main()
