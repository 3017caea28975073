// Paragraphs, formulas and numbers.
import katex from "katex";
import { element } from "./dom";

export function formula(latex: string, display: boolean): HTMLElement {
  const made = element(display ? "div" : "span", { class: display ? "formula" : "inline-formula" });
  katex.render(latex, made, { displayMode: display, output: "mathml", throwOnError: false });
  return made;
}

// Text with formulas in dollars and code in backticks.
export function rich(text: string): DocumentFragment {
  const made = document.createDocumentFragment();
  for (const part of text.split(/(\$[^$]+\$|`[^`]+`)/)) {
    if (part.startsWith("$") && part.length > 2) made.append(formula(part.slice(1, -1), false));
    else if (part.startsWith("`") && part.length > 2) made.append(element("code", {}, part.slice(1, -1)));
    else if (part) made.append(part);
  }
  return made;
}

const superscripts = "⁰¹²³⁴⁵⁶⁷⁸⁹";

export function powerOfTen(exponent: number): string {
  const digits = [...String(Math.abs(exponent))].map((d) => superscripts[Number(d)]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

// A number for people: about four digits, powers of ten where it is far from one.
export function readable(x: number | null, digits = 4): string {
  if (x === null || !Number.isFinite(x)) return "–";
  if (x === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(x)));
  if (Number.isInteger(x) && Math.abs(x) < 1e7) return minus(String(x));
  if (exponent < -3 || exponent > 5) {
    const scaled = x / 10 ** exponent;
    return minus(`${Number(scaled.toPrecision(Math.min(digits, 3)))} × ${powerOfTen(exponent)}`);
  }
  return minus(x.toPrecision(Math.max(digits, exponent + 1)).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, ""));
}

const minus = (text: string): string => text.replace(/^-/, "−");
