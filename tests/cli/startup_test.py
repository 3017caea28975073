"""What the program loads before it does anything: little, so that it starts at once."""
import os
import re
import subprocess
import unittest

from program import ENVIRONMENT, PROGRAM, ProgramTest, write_pfm


class StartUp(ProgramTest):
    def loaded_libraries(self):
        result = subprocess.run([PROGRAM], env={**ENVIRONMENT, "LD_TRACE_LOADED_OBJECTS": "1"}, text=True,
                                capture_output=True, check=True)
        return result.stdout.splitlines()

    def test_the_library_of_image_formats_and_all_that_it_needs_wait_until_a_format_needs_them(self):
        libraries = self.loaded_libraries()
        self.assertTrue(any("libembree" in line for line in libraries))  # the list is one of libraries
        self.assertFalse([line for line in libraries if "OpenImageIO" in line or "codec" in line])
        self.assertLess(len(libraries), 60)  # 264 with it

    def test_openexr_needs_no_library_of_formats(self):
        self.render("--spp", "4", "-o", "a.exr")
        for command in ["info", "a.exr"], ["tonemap", "a.exr", "-o", "a.png"], ["diff", "a.exr", "a.exr"]:
            result = subprocess.run([PROGRAM, *command], cwd=self.folder, env={**ENVIRONMENT, "LD_DEBUG": "libs"}, text=True,
                                    capture_output=True, check=True)
            loaded = re.findall(r"calling init: (\S+)", result.stderr)
            self.assertTrue([library for library in loaded if "libOpenEXR" in library])
            self.assertFalse([library for library in loaded if "OpenImageIO" in library])

    def test_formats_work_from_any_folder_and_by_any_name_of_the_program(self):
        write_pfm(self.folder / "gray.pfm", 8, 8, (0.5, 0.5, 0.5))
        link = self.folder / "link"
        os.symlink(PROGRAM, link)
        result = subprocess.run([link, "tonemap", "gray.pfm", "-o", "gray.png"], cwd=self.folder, env=ENVIRONMENT, text=True,
                                capture_output=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater((self.folder / "gray.png").stat().st_size, 0)


if __name__ == "__main__":
    unittest.main()
