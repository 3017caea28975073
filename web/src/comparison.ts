// Pictures in linear values, a set at a time: compared with each other, brighter or darker, their errors, and every pixel
// read out with its error bar and with how its mean settled.
import { element } from "./dom";
import { paintError, paintPicture, unpackPicture, type Pixels } from "./pixels";
import type { ComparisonSection } from "./report";
import { settling } from "./settling";
import { plusMinus, readable, rich } from "./text";
import { Viewer, zoomHint } from "./viewer";

interface Painted { pixels: Pixels; canvas: HTMLCanvasElement }

class View {
  readonly element: HTMLElement;
  private readonly all: Painted[];
  private readonly panel = element("div", { class: "pixel", role: "status" }, "Point at a pixel to read it.");
  private readonly errorsButton = element("button", { type: "button", "aria-pressed": "false" }, "errors");
  private readonly viewer: Viewer;
  private readonly mainSet: string;
  private set: string;
  private stops = 0;
  private errors = false;

  constructor(section: ComparisonSection) {
    this.all = section.pictures.map((picture) => ({ pixels: unpackPicture(picture), canvas: element("canvas", {}) }));
    this.set = this.mainSet = this.all[0]!.pixels.set;
    this.errorsButton.addEventListener("click", () => {
      this.errors = !this.errors;
      this.errorsButton.setAttribute("aria-pressed", String(this.errors));
      this.paint();
    });
    const sets = [...new Set(this.all.map(({ pixels }) => pixels.set))];
    const controls = [this.errorsButton, this.exposure()];
    this.viewer = new Viewer({
      columns: 3,
      view: "grid",
      controls: sets.length > 1 ? [this.setChoice(sets), ...controls] : controls,
      onPoint: (u, v) => this.readOut(u, v),
    });
    this.show(this.set);
    this.element = element("div", { class: "comparison" }, this.viewer.element, this.panel);
  }

  private get shown(): Painted[] {
    return this.all.filter(({ pixels }) => pixels.set === this.set);
  }

  private show(set: string): void {
    this.set = set;
    this.errorsButton.hidden = set !== this.mainSet;
    this.paint();
    this.viewer.load(this.shown.map(({ pixels, canvas }) =>
      ({ caption: pixels.name, width: pixels.width, height: pixels.height, view: canvas })));
    this.panel.replaceChildren("Point at a pixel to read it.");
  }

  private paint(): void {
    const reference = this.all[0]!.pixels;
    for (const { pixels, canvas } of this.shown) {
      if (this.errors && this.set === this.mainSet && pixels !== reference) paintError(canvas, pixels, reference, this.stops);
      else paintPicture(canvas, pixels, this.stops);
    }
  }

  private setChoice(sets: string[]): HTMLElement {
    const select = element("select", { "aria-label": "show" }, ...sets.map((set) => element("option", { value: set }, set)));
    select.addEventListener("change", () => this.show(select.value));
    return element("label", {}, "show ", select);
  }

  private exposure(): HTMLElement {
    const input = element("input", { type: "range", min: "-8", max: "8", step: "0.25", value: "0", "aria-label": "exposure" });
    const stops = element("output", {}, "0");
    input.addEventListener("input", () => {
      this.stops = Number(input.value);
      stops.textContent = readable(this.stops);
      this.paint();
    });
    return element("label", {}, "exposure ", input, stops);
  }

  private readOut(u: number, v: number): void {
    const { width, height, channels } = this.shown[0]!.pixels;
    const [x, y] = [Math.floor(u * width), Math.floor(v * height)];
    const pixel = y * width + x;
    const columns = channels === 1 ? ["share"] : ["red", "green", "blue"];
    const rows = this.shown.map(({ pixels }) => {
      const cells = columns.map((_, c) => {
        const at = channels * pixel + c;
        const error = pixels.error[at];
        const mean = pixels.mean[at]!;
        return element("td", { class: "number" }, error === undefined ? readable(Number(mean.toPrecision(4))) : plusMinus(mean, error));
      });
      return element("tr", {}, element("th", {}, rich(pixels.name)), ...cells);
    });
    const head = element("tr", {}, element("th", {}, `pixel ${x}, ${y}`),
      ...columns.map((name) => element("th", { class: "number" }, name)));
    const run = this.set === this.mainSet ? [settling(this.shown.map(({ pixels }) => pixels), pixel)] : [];
    this.panel.replaceChildren(element("div", { class: "scroll" }, element("table", {}, head, ...rows)), ...run);
  }
}

export function comparisonView(section: ComparisonSection): HTMLElement {
  const hint = element("span", { class: "hint" }, zoomHint);
  return element("figure", {}, new View(section).element, element("figcaption", {}, rich(section.caption), " ", hint));
}
