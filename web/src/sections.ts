// One view for each kind of section.
import { comparisonView } from "./comparison";
import { element } from "./dom";
import { figureView } from "./figure";
import { imagesView } from "./images";
import type { CommandsSection, FactsSection, FormulaSection, Section, TableSection, VerdictSection } from "./report";
import { fitFormula, formula, readable, rich } from "./text";

function formulaView(section: FormulaSection): HTMLElement {
  const shown = formula(section.latex, true);
  const made = element("div", { class: "statement" }, shown);
  let width = 0;
  new ResizeObserver(() => {
    if (made.clientWidth !== width) fitFormula(shown);
    width = made.clientWidth;
  }).observe(made);
  if (section.source) made.append(element("div", { class: "source" }, rich(section.source)));
  return made;
}

function tableView(table: TableSection): HTMLElement {
  const numeric = table.columns.map((_, c) => table.rows.every((row) => typeof row[c] !== "string"));
  const cell = (tag: "th" | "td", c: number, content: Node | string): HTMLElement =>
    element(tag, numeric[c] ? { class: "number" } : {}, content);
  const head = element("tr", {}, ...table.columns.map((name, c) => cell("th", c, rich(name))));
  const rows = table.rows.map((row) =>
    element("tr", {}, ...row.map((value, c) => cell("td", c, typeof value === "string" ? rich(value) : readable(value)))),
  );
  const made = element("table", {}, element("thead", {}, head), element("tbody", {}, ...rows));
  return element("figure", { class: "table" }, element("figcaption", {}, rich(table.caption)),
    element("div", { class: "scroll" }, made));
}

function factsView(facts: FactsSection): HTMLElement {
  return element("dl", { class: "facts" },
    ...facts.rows.map(([name, value]) => element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}

function verdictView(verdict: VerdictSection): HTMLElement {
  const mark = element("span", { class: "mark", "aria-label": verdict.passed ? "holds" : "fails" }, verdict.passed ? "✓" : "✗");
  const words = element("div", {}, element("div", { class: "claim" }, rich(verdict.claim)),
    element("div", { class: "detail" }, rich(verdict.detail)));
  return element("div", { class: verdict.passed ? "verdict holds" : "verdict fails" }, mark, words);
}

function commandsView(commands: CommandsSection): HTMLElement {
  return element("pre", { class: "commands" }, element("code", {}, commands.lines.join("\n")));
}

export function sectionView(section: Section): HTMLElement {
  switch (section.kind) {
    case "text":
      return element("p", {}, rich(section.text));
    case "formula":
      return formulaView(section);
    case "table":
      return tableView(section);
    case "facts":
      return factsView(section);
    case "figure":
      return figureView(section);
    case "images":
      return imagesView(section);
    case "comparison":
      return comparisonView(section);
    case "verdict":
      return verdictView(section);
    case "commands":
      return commandsView(section);
  }
}
