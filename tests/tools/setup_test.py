"""tools/setup requests from apt-get what is missing and for nothing else; the package system is played by small scripts."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[2] / "tools" / "setup"
PACKAGES = subprocess.run([str(TOOL), "--list"], capture_output=True, text=True, check=True).stdout.split()


class Setup(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.bin = Path(self.folder.name) / "bin"
        self.bin.mkdir()
        self.installed = Path(self.folder.name) / "installed"
        self.log = Path(self.folder.name) / "log"
        self.log.touch()
        # Only these commands exist on the machine that is played.
        for name in ("bash", "sed", "env", "grep", "cut", "dirname", "cat"):
            (self.bin / name).symlink_to(subprocess.run(["which", name], capture_output=True, text=True,
                                                        check=True).stdout.strip())
        self.command("sudo", 'exec "$@"')

    def command(self, name, text):
        path = self.bin / name
        path.write_text("#!/usr/bin/env bash\n" + text + "\n")
        path.chmod(0o755)

    def debian(self, installed, offered=None, gcc="12"):
        self.installed.write_text("\n".join(installed) + "\n")
        offered = PACKAGES if offered is None else offered
        (Path(self.folder.name) / "offered").write_text("\n".join(offered) + "\n")
        self.command("dpkg-query", f'grep -qx -- "${{!#}}" {self.installed} && printf "ii "')
        self.command("apt-cache", f'grep -qx -- "${{!#}}" {self.folder.name}/offered && echo "Package: ${{!#}}"')
        self.command("apt-get", f'echo "$@" >> {self.log}\n'
                                f'for word in "$@"; do echo "$word" >> {self.installed}; done')
        self.command("g++", f"echo {gcc}")

    def run_tool(self, *arguments):
        result = subprocess.run([str(TOOL), *arguments], env={"PATH": str(self.bin), "HOME": os.environ.get("HOME", "/")},
                                capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        return result.returncode, result.stdout + result.stderr, self.log.read_text()

    def test_nothing_is_run_when_nothing_is_missing(self):
        self.debian(PACKAGES)
        status, output, log = self.run_tool()
        self.assertEqual((status, log), (0, ""), output)

    def test_only_what_is_missing_is_installed_and_a_second_run_does_nothing(self):
        self.debian([name for name in PACKAGES if name not in ("ninja-build", "libfmt-dev")])
        status, output, log = self.run_tool()
        self.assertEqual(status, 0, output)
        self.assertEqual(log.splitlines()[-1].split("recommends")[1].split(), ["ninja-build", "libfmt-dev"])
        self.assertEqual(self.run_tool()[2], log)

    def test_a_package_is_not_installed_where_its_command_is_there_already(self):
        self.debian([name for name in PACKAGES if name not in ("nodejs", "npm", "zlib1g-dev")])
        self.command("node", "echo v20.0.0")
        status, output, log = self.run_tool()
        self.assertEqual(status, 0, output)
        self.assertEqual(log.splitlines()[-1].split("recommends")[1].split(), ["zlib1g-dev", "npm"])

    def test_what_only_tests_need_can_be_left_out(self):
        self.debian([])
        self.assertIn("chromium", self.run_tool("--dry-run")[1])
        status, output, _ = self.run_tool("--no-tests", "--dry-run")
        self.assertEqual(status, 0, output)
        self.assertNotIn("chromium", output)
        self.assertIn("libembree-dev", output)

    def test_a_dry_run_installs_nothing(self):
        self.debian([])
        status, output, log = self.run_tool("--dry-run")
        self.assertEqual((status, log), (0, ""), output)
        self.assertIn("libembree-dev", output)

    def test_a_package_that_is_not_offered_is_named_and_the_rest_installed(self):
        self.debian([], offered=[name for name in PACKAGES if name != "libembree-dev"])
        status, output, log = self.run_tool()
        self.assertEqual(status, 0, output)
        self.assertIn("still missing: libembree-dev", output)
        self.assertNotIn("libembree-dev", log)
        self.assertIn("libtbb-dev", log)

    def test_an_old_compiler_gets_version_12_beside_it(self):
        self.debian(PACKAGES, offered=PACKAGES + ["g++-12"], gcc="11")
        status, output, log = self.run_tool()
        self.assertEqual(status, 0, output)
        self.assertIn("g++-12", log)

    def test_a_system_without_apt_is_reported_what_is_missing_and_continues(self):
        status, output, log = self.run_tool()
        self.assertEqual((status, log), (0, ""), output)
        self.assertIn("missing: cmake", output)
        self.assertIn("Embree", output)

    def test_an_unknown_argument_is_an_error(self):
        self.debian(PACKAGES)
        self.assertEqual(self.run_tool("--nonsense")[0], 2)


if __name__ == "__main__":
    unittest.main()
