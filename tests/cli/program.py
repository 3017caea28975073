"""The program under test, and the little that its tests share."""
import array
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(sys.argv.pop(1) if len(sys.argv) > 1 else ROOT / "build" / "release" / "montelux")
SCENE = ROOT / "scenes" / "first-light" / "first-light.pbrt"

# Files carry no time of their own, messages no colour, and a terminal is one that can redraw a line.
ENVIRONMENT = {**os.environ, "SOURCE_DATE_EPOCH": "0", "NO_COLOR": "1", "TERM": "xterm"}


# Sanitizers make the program slow: how many times the usual seconds it may take.
SANITIZED = bool(os.environ.get("MONTELUX_SANITIZE"))
SLOWNESS = 10 if SANITIZED else 1


class ProgramTest(unittest.TestCase):
    """A test with a folder of its own, in which the program runs."""

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)

    def start(self, *arguments, **options):
        return subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                                **{"env": ENVIRONMENT, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options})

    def run_program(self, *arguments, status=0, **variables):
        """Runs the program to its end and checks its exit status, which may be one of several; returns what it said.
        `variables` are added to the environment."""
        result = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, env=ENVIRONMENT | variables, text=True,
                                capture_output=True, check=False)
        good = status if isinstance(status, tuple) else (status,)
        self.assertIn(result.returncode, good, f"{arguments}\n{result.stdout}{result.stderr}")
        return result

    def render(self, *arguments, scene=SCENE, **options):
        return self.run_program("render", scene, "--resolution", "64x48", *arguments, **options)


def write_pfm(path, width, height, color):
    """A picture of one colour."""
    values = array.array("f", list(color) * (width * height))
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + values.tobytes())


def read_pfm(path):
    """(width, height, rows), the top row first; a row is three numbers for each pixel."""
    kind, size, scale, data = path.read_bytes().split(b"\n", 3)
    assert kind == b"PF" and float(scale) == -1
    width, height = map(int, size.split())
    values = array.array("f", data)
    rows = [values[y * 3 * width:(y + 1) * 3 * width] for y in range(height)]
    return width, height, rows[::-1]


def relative_error(picture, reference):
    """Mean of the squared errors over the squares of the reference, plus 0.01."""
    pairs = [pair for rows in zip(picture[2], reference[2]) for pair in zip(*rows)]
    return sum((a - b) ** 2 / (b ** 2 + 0.01) for a, b in pairs) / len(pairs)
