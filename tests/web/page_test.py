#!/usr/bin/env python3
"""usage: page_test.py MONTELUX WEB_BUILD_FOLDER [page|comparison]

Makes a report and opens it in headless Chromium (web/test/page.mjs or comparison.mjs). Skipped, with a message and the
exit status 77, where the page was not built or no Chromium is there. Pictures of it go to the folder that the environment
variable MONTELUX_SCREENSHOTS names.
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
    kind = sys.argv[3] if len(sys.argv) > 3 else "page"
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as folder:
        # Beside the packages it imports.
        script = build / f"{kind}_test.mjs"
        script.write_text((root / "web" / "test" / f"{kind}.mjs").read_text())
        (build / "browser.mjs").write_text((root / "web" / "test" / "browser.mjs").read_text())
        # Before the report is made, which takes long.
        look = "import('./browser.mjs').then((browser) => process.exit(browser.findBrowser() ? 0 : 1))"
        if subprocess.run([node, "-e", look], cwd=build, check=False).returncode != 0:
            print("skipped: no Chromium on this machine")
            return SKIPPED
        report = Path(folder) / "report.html"
        if kind == "page":
            make = [program, "lab", "run", "all", "-q", "-o", folder]
        else:
            scene = root / "scenes" / "first-light" / "first-light.pbrt"
            make = [program, "compare", scene, "--resolution", "64x48", "--spp", "4", "--repeats", "4", "-a", "path",
                    "-b", "path:mis=balance", "--no-cache", "--quiet", "-o", report]
        subprocess.run(make, check=True, stdout=subprocess.DEVNULL)
        shots = os.environ.get("MONTELUX_SCREENSHOTS", "")
        return subprocess.run([node, script, report, *([shots] if shots else [])], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
