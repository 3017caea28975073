#!/usr/bin/env python3
"""usage: page_test.py MONTELUX WEB_BUILD_FOLDER

Makes a report and opens it in headless Chromium (web/test/page.mjs). Skipped, with a message and the exit status 77,
where the page was not built or no Chromium is there.
"""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77


def main():
    program, build = sys.argv[1], Path(sys.argv[2])
    node = shutil.which("node") or shutil.which("nodejs")
    if not node or not (build / "node_modules" / "playwright-core").is_dir():
        print("skipped: the page of reports was not built (node and npm are needed)")
        return SKIPPED
    source = Path(__file__).resolve().parents[2] / "web" / "test" / "page.mjs"
    with tempfile.TemporaryDirectory() as folder:
        # Beside the packages it imports.
        script = build / "page_test.mjs"
        script.write_text(source.read_text())
        subprocess.run([program, "lab", "run", "all", "-q", "-o", folder], check=True, stdout=subprocess.DEVNULL)
        shots = os.environ.get("MONTELUX_SCREENSHOTS", "")
        return subprocess.run([node, script, Path(folder) / "report.html", *([shots] if shots else [])],
                              check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
