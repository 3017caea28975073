// Pictures of one size, held against each other: side by side, one over the other with a line to draw, or flipped; their
// errors; and every pixel read out with its error bar and with how its mean settled.
import { element } from "./dom";
import { paintError, paintPicture, unpackPicture, type Pixels } from "./pixels";
import type { ComparisonSection } from "./report";
import { settling } from "./settling";
import { readable, rich } from "./text";
import { SharedZoom } from "./zoom";

type Mode = "side by side" | "slider" | "flip";
const modes: Mode[] = ["side by side", "slider", "flip"];

class View {
  private readonly pictures: Pixels[];
  private readonly zoom = new SharedZoom();
  private readonly frames: HTMLElement[] = [];
  private readonly canvases: HTMLCanvasElement[] = [];
  private readonly stage = element("div", { class: "stage" });
  private readonly panel = element("div", { class: "pixel", role: "status" }, "Point at a pixel to read it.");
  private mode: Mode = "side by side";
  private stops = 0;
  private errors = false;
  private chosen: [number, number];
  private line = 0.5;
  private flipped = false;

  constructor(section: ComparisonSection) {
    this.pictures = section.pictures.map(unpackPicture);
    this.chosen = [Math.min(1, this.pictures.length - 1), Math.min(2, this.pictures.length - 1)];
    for (const picture of this.pictures) {
      const canvas = element("canvas", {});
      const frame = element("div", { class: "frame", style: `aspect-ratio: ${picture.width} / ${picture.height}` }, canvas);
      this.zoom.add(frame, canvas);
      this.frames.push(frame);
      this.canvases.push(canvas);
      frame.addEventListener("pointermove", (event) => this.readOut(canvas, event));
    }
    this.stage.addEventListener("click", () => this.mode === "flip" && this.flip());
  }

  element(): HTMLElement {
    this.paint();
    this.arrange();
    return element("div", { class: "comparison" }, this.controls(), this.stage, this.panel);
  }

  private paint(): void {
    this.pictures.forEach((picture, i) => {
      if (this.errors && i > 0) paintError(this.canvases[i]!, picture, this.pictures[0]!, this.stops);
      else paintPicture(this.canvases[i]!, picture, this.stops);
    });
  }

  private labelled(i: number): HTMLElement {
    return element("div", { class: "picture" }, this.frames[i]!, element("div", { class: "caption" }, rich(this.pictures[i]!.name)));
  }

  private arrange(): void {
    this.stage.className = `stage ${this.mode.replaceAll(" ", "-")}`;
    for (const frame of this.frames) frame.style.clipPath = "";
    if (this.mode === "side by side") {
      this.stage.style.setProperty("--columns", String(Math.min(3, this.pictures.length)));
      this.stage.replaceChildren(...this.pictures.map((_, i) => this.labelled(i)));
      return;
    }
    const [a, b] = this.chosen;
    const under = this.labelled(a);
    const over = element("div", { class: "picture over" }, a === b ? "" : this.frames[b]!);
    if (this.mode === "slider") this.frames[b]!.style.clipPath = `inset(0 0 0 ${100 * this.line}%)`;
    else over.style.visibility = this.flipped ? "visible" : "hidden";
    const caption = under.querySelector(".caption")!;
    if (this.mode === "slider") caption.replaceChildren(rich(`left: ${this.pictures[a]!.name}; right: ${this.pictures[b]!.name}`));
    else caption.replaceChildren(rich(`${this.pictures[this.flipped ? b : a]!.name} (click to flip)`));
    this.stage.replaceChildren(under, over);
  }

  private flip(): void {
    this.flipped = !this.flipped;
    this.arrange();
  }

  private choice(label: string, place: 0 | 1): HTMLElement {
    const options = this.pictures.map((picture, i) =>
      element("option", { value: String(i), ...(i === this.chosen[place] ? { selected: "" } : {}) }, picture.name));
    const select = element("select", { "aria-label": label }, ...options);
    select.addEventListener("change", () => {
      this.chosen[place] = Number(select.value);
      this.arrange();
    });
    return element("label", {}, `${label} `, select);
  }

  private slider(label: string, low: number, high: number, step: number, value: number, set: (x: number) => void): HTMLElement {
    const input = element("input", {
      type: "range", min: String(low), max: String(high), step: String(step), value: String(value), "aria-label": label,
    });
    input.addEventListener("input", () => set(Number(input.value)));
    return element("label", {}, `${label} `, input);
  }

  private controls(): HTMLElement {
    const pair = element("span", { class: "pair" }, this.choice("first", 0), this.choice("second", 1),
      this.slider("line", 0, 1, 0.005, this.line, (x) => {
        this.line = x;
        this.arrange();
      }));
    const buttons = modes.map((mode) => {
      const button = element("button", { type: "button", "aria-pressed": String(mode === this.mode) }, mode);
      button.addEventListener("click", () => {
        this.mode = mode;
        buttons.forEach((other) => other.setAttribute("aria-pressed", String(other === button)));
        pair.classList.toggle("shown", mode !== "side by side");
        this.arrange();
      });
      return button;
    });
    const errors = element("button", { type: "button", "aria-pressed": "false" }, "errors");
    errors.addEventListener("click", () => {
      this.errors = !this.errors;
      errors.setAttribute("aria-pressed", String(this.errors));
      this.paint();
    });
    const exposure = this.slider("exposure", -8, 8, 0.25, 0, (x) => {
      this.stops = x;
      this.paint();
    });
    return element("div", { class: "controls" }, ...buttons, errors, exposure, pair);
  }

  private readOut(canvas: HTMLCanvasElement, event: PointerEvent): void {
    const box = canvas.getBoundingClientRect();
    const { width, height } = this.pictures[0]!;
    const x = Math.floor(((event.clientX - box.left) / box.width) * width);
    const y = Math.floor(((event.clientY - box.top) / box.height) * height);
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    const pixel = y * width + x;
    const rows = this.pictures.map((picture) => {
      const cells = [0, 1, 2].map((c) => {
        const error = picture.error[3 * pixel + c];
        const bar = error === undefined ? "" : ` ± ${readable(Number(error.toPrecision(2)))}`;
        return element("td", { class: "number" }, `${readable(Number(picture.mean[3 * pixel + c]!.toPrecision(4)))}${bar}`);
      });
      return element("tr", {}, element("th", {}, rich(picture.name)), ...cells);
    });
    const head = element("tr", {}, element("th", {}, `pixel ${x}, ${y}`), ...["red", "green", "blue"].map((c) => element("th", { class: "number" }, c)));
    this.panel.replaceChildren(element("table", {}, head, ...rows), settling(this.pictures, pixel));
  }
}

export function comparisonView(section: ComparisonSection): HTMLElement {
  const hint = element("span", { class: "hint" }, "Double-click to zoom all, drag to pan, shift and double-click to reset.");
  return element("figure", {}, new View(section).element(), element("figcaption", {}, rich(section.caption), " ", hint));
}
