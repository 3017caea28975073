// usage: node embed.mjs PAGE.html PAGE.cpp
// Writes the page as a C++ source that holds its bytes as a constant.
import { readFileSync, writeFileSync } from "node:fs";

const [, , pageFile, sourceFile] = process.argv;
const bytes = readFileSync(pageFile);
const mark = "@@REPORT-DATA@@";
if (bytes.toString("utf8").split(mark).length !== 2) throw new Error(`${pageFile} must have ${mark} once`);

const escapes = new Map([[10, "\\n"], [34, '\\"'], [63, "\\?"], [92, "\\\\"]]);
const letter = (byte) =>
  escapes.get(byte) ??
  (byte >= 32 && byte < 127 ? String.fromCharCode(byte) : `\\${byte.toString(8).padStart(3, "0")}`);

// Compilers bound the length of one literal; neighbours are joined.
const size = 4000;
const pieces = [];
for (let i = 0; i < bytes.length; i += size) pieces.push(`"${Array.from(bytes.subarray(i, i + size), letter).join("")}"`);
writeFileSync(sourceFile, `// Made from web/: the page of reports.
#include "lab/report/page.h"

namespace montelux::lab {

namespace {
constexpr char html[] =
${pieces.join("\n")};
}  // namespace

Page page() { return {{html, sizeof(html) - 1}, ""}; }

}  // namespace montelux::lab
`);
