"""tools/check_globals finds planted mutable globals in an object file, and lets constants pass."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "check_globals"
COMPILER = os.environ.get("CXX", "g++")


@unittest.skipUnless(shutil.which(COMPILER) and shutil.which("objdump"), "needs a compiler and objdump")
class CheckGlobals(unittest.TestCase):
    def check(self, source, allow=None):
        """Compiles the source and returns the tool's (exit status, output)."""
        with tempfile.TemporaryDirectory() as folder:
            code, compiled = Path(folder) / "code.cpp", Path(folder) / "code.o"
            code.write_text(source)
            subprocess.run([COMPILER, "-std=c++20", "-O1", "-fPIC", "-c", str(code), "-o", str(compiled)], check=True)
            command = [sys.executable, str(TOOL), str(compiled)]
            if allow is not None:
                listing = Path(folder) / "allowed.txt"
                listing.write_text(allow)
                command += ["--allow", str(listing)]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            return result.returncode, result.stdout + result.stderr

    def assert_found(self, source, name):
        status, output = self.check(source)
        self.assertEqual(status, 1, output)
        self.assertIn(name, output)

    def test_an_initialised_global_is_found(self):
        self.assert_found("namespace montelux { int counter = 3; }", "montelux::counter")

    def test_a_zeroed_global_is_found(self):
        self.assert_found("namespace montelux { double table[8]; }", "montelux::table")

    def test_a_hidden_static_is_found(self):
        self.assert_found("static int calls; int next() { return ++calls; }", "calls")

    def test_a_static_inside_a_function_is_found(self):
        self.assert_found("int next() { static int calls = 5; return ++calls; }", "calls")

    def test_a_thread_local_is_found(self):
        self.assert_found("thread_local int depth = 1; int next() { return ++depth; }", "depth")

    def test_constants_names_and_virtual_tables_pass(self):
        status, output = self.check("""
            #include <string_view>
            struct Shape { virtual ~Shape(); virtual int sides() const { return 0; } };
            Shape::~Shape() = default;
            extern const double primes[3] = {2, 3, 5};
            extern constexpr std::string_view names[2] = {"one", "two"};
            const std::string_view* find(int i) { return &names[i]; }
        """)
        self.assertEqual(status, 0, output)

    def test_an_allowed_name_passes_and_needs_a_reason(self):
        source = "namespace montelux { int stop_signal = 1; }"
        self.assertEqual(self.check(source, "montelux::stop_signal # set by a signal handler\n")[0], 0)
        status, output = self.check(source, "montelux::stop_signal\n")
        self.assertNotEqual(status, 0)
        self.assertIn("a reason is missing", output)


if __name__ == "__main__":
    unittest.main()
