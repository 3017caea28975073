// Paragraphs, formulas and numbers.
import katex from "katex";
import { element } from "./dom";

export function formula(latex: string, display: boolean): HTMLElement {
  const made = element(display ? "div" : "span", { class: display ? "formula" : "inline-formula" });
  katex.render(latex, made, { displayMode: display, output: "mathml", throwOnError: false });
  return made;
}

// Formulas on a line of their own become smaller where they are too wide for it, but stay readable; what is wider still
// scrolls, and shows that it does.
export function fitFormula(made: HTMLElement): void {
  const minSize = 0.7;
  made.style.fontSize = "";
  made.classList.remove("scrolls");
  const excess = made.scrollWidth / made.clientWidth;
  if (!(excess > 1)) return;
  made.style.fontSize = `${Math.max(minSize, 0.98 / excess)}em`;
  made.classList.toggle("scrolls", made.scrollWidth > made.clientWidth + 1);
}

// Text that may wrap between the parts of the long words in it: after the colon, the comma and the equals sign of
// "path:mis=balance,roulette=efficiency". Short values stay with their keys.
function wrappable(text: string): Node[] {
  const breaks = /(?<=[\p{L}\d][:,_/])(?=[\p{L}\d])|(?<=[\p{L}\d]=)(?=[\p{L}\d.-]{4})/u;
  return text.split(/(\s+)/).flatMap((word) =>
    word.length < 12 || !/\p{L}/u.test(word) ? [document.createTextNode(word)]
      : word.split(breaks).flatMap((part, i) => [...(i > 0 ? [element("wbr")] : []), document.createTextNode(part)]));
}

// Text with formulas in dollars and code in backticks.
export function rich(text: string): DocumentFragment {
  const made = document.createDocumentFragment();
  for (const part of text.split(/(\$[^$]+\$|`[^`]+`)/)) {
    if (part.startsWith("$") && part.length > 2) made.append(formula(part.slice(1, -1), false));
    else if (part.startsWith("`") && part.length > 2) made.append(element("code", {}, part.slice(1, -1)));
    else if (part) made.append(...wrappable(part));
  }
  made.normalize();
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

// "540 ± 100": the error with two digits, the value to the same place; both with one power of ten where they are far from
// one.
export function plusMinus(value: number, error: number): string {
  if (!Number.isFinite(error) || error <= 0) return `${readable(value)}${error === 0 ? " ± 0" : ""}`;
  const size = Math.max(Math.abs(value), error);
  const exponent = size < 1e-3 || size >= 1e7 ? Math.floor(Math.log10(size)) : 0;
  const unit = 10 ** exponent;
  const digits = Number((error / unit).toPrecision(2));
  const places = 1 - Math.floor(Math.log10(digits) + 1e-9);
  const shown = (x: number): string => (places >= 0 ? x.toFixed(places) : String(Math.round(x * 10 ** places) / 10 ** places));
  const text = `${minus(shown(value / unit))} ± ${shown(digits)}`;
  return exponent === 0 ? text : `(${text}) × ${powerOfTen(exponent)}`;
}

const minus = (text: string): string => text.replace(/^-/, "−");
