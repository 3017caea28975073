// Pictures of one size, compared with each other: in a grid, two at one place with a line between them, or one after the
// other; they zoom and pan together.
import { element } from "./dom";
import type { ImagesView } from "./report";
import { rich } from "./text";
import { SharedZoom } from "./zoom";

export interface Shown {
  caption: string;
  width: number;
  height: number;
  view: HTMLElement; // an img or a canvas
}

export interface ViewerOptions {
  columns: number;
  view: ImagesView;
  controls?: HTMLElement[]; // more of them, beside the choice of the view
  // The pointer is at this place of a picture, in parts of its width and height.
  onPoint?: (u: number, v: number) => void;
}

const views = [["grid", "Side by side"], ["slider", "Slider"], ["flip", "Flip"]] as const;
const title = (caption: string, i: number): string => `${i + 1}. ${caption.split("\n").slice(0, 2).join(", ")}`;

export const zoomHint =
  "Double-click to zoom all, drag to pan, shift and double-click to reset. Drag the slider's line, or move it by the arrow keys.";

export class Viewer {
  readonly element: HTMLElement;
  private readonly zoom = new SharedZoom();
  private readonly grid = element("div", { class: "pictures" });
  private readonly curtain = element("div", { class: "curtain" });
  private readonly divider = element("div", {
    class: "divider", role: "slider", tabindex: "0", "aria-label": "line between the pictures", "aria-valuemin": "0", "aria-valuemax": "100",
  });
  private readonly frame = element("div", { class: "frame", tabindex: "0" });
  private readonly left = element("select", { "aria-label": "left or first picture" });
  private readonly right = element("select", { "aria-label": "right or second picture" });
  private readonly flip = element("button", { type: "button" }, "Flip");
  private readonly now = element("div", { class: "caption" });
  private readonly stage = element("div", { class: "stage" },
    element("div", { class: "choose" }, this.left, this.flip, this.right), this.frame, this.now);
  private readonly switcher = element("div", { class: "switcher", role: "group", "aria-label": "View" });
  private readonly framed = new Map<HTMLElement, HTMLElement>(); // a view, and its place in the grid
  private pictures: Shown[] = [];
  private mode: ImagesView;
  private first = true; // the flip shows the first of the two
  private line = 50; // where the slider's line is, in percent
  private dragged: number | null = null; // the pointer that drags the line

  constructor(private readonly options: ViewerOptions) {
    this.mode = options.view;
    for (const [name, label] of views) {
      const button = element("button", { type: "button", "data-view": name }, label);
      button.addEventListener("click", () => this.show(name));
      this.switcher.append(button);
    }
    this.zoom.add(this.frame);
    this.left.addEventListener("change", () => this.arrange());
    this.right.addEventListener("change", () => this.arrange());
    this.flip.addEventListener("click", () => this.toggle());
    this.frame.addEventListener("pointerdown", (event) => this.onDown(event));
    this.frame.addEventListener("pointermove", (event) => this.onMove(event));
    for (const kind of ["pointerup", "pointercancel"] as const) this.frame.addEventListener(kind, () => (this.dragged = null));
    this.frame.addEventListener("click", () => this.mode === "flip" && this.toggle());
    this.frame.addEventListener("keydown", (event) => this.onKey(event));
    this.element = element("div", { class: "viewer" },
      element("div", { class: "controls" }, this.switcher, ...(options.controls ?? [])), this.grid, this.stage);
  }

  // Puts these pictures on show. Views that were on show before keep their zoom.
  load(pictures: Shown[]): void {
    this.pictures = pictures;
    for (const picture of pictures) if (!this.framed.has(picture.view)) this.framed.set(picture.view, this.makeFrame(picture));
    for (const select of [this.left, this.right])
      select.replaceChildren(...pictures.map((picture, i) => element("option", { value: String(i) }, title(picture.caption, i))));
    const last = pictures.length - 1;
    this.left.value = String(Math.min(pictures.length > 2 ? 1 : 0, last));
    this.right.value = String(Math.min(pictures.length > 2 ? 2 : 1, last));
    this.switcher.hidden = pictures.length < 2;
    const { width, height } = pictures[0]!;
    this.frame.style.aspectRatio = `${width} / ${height}`;
    this.grid.style.setProperty("--columns", String(Math.min(this.options.columns, pictures.length)));
    this.show(pictures.length < 2 ? "grid" : this.mode);
  }

  private show(mode: ImagesView): void {
    this.mode = mode;
    for (const button of this.switcher.children) button.setAttribute("aria-pressed", String((button as HTMLElement).dataset.view === mode));
    this.grid.hidden = mode !== "grid";
    this.stage.hidden = mode === "grid";
    this.divider.hidden = mode !== "slider";
    this.frame.classList.toggle("slides", mode === "slider");
    this.flip.hidden = mode !== "flip";
    this.first = true;
    this.arrange();
  }

  private arrange(): void {
    if (this.mode === "grid") {
      this.grid.replaceChildren(...this.pictures.map(({ view }) => {
        const place = this.framed.get(view)!;
        place.firstElementChild!.replaceChildren(view);
        return place;
      }));
      return;
    }
    const [a, b] = [this.pictures[Number(this.left.value)]!, this.pictures[Number(this.right.value)]!];
    this.curtain.replaceChildren(...(a === b ? [] : [a.view]));
    this.frame.replaceChildren(b.view, this.curtain, this.divider);
    this.split(this.mode === "slider" ? this.line : this.first ? 100 : 0);
  }

  private makeFrame(picture: Shown): HTMLElement {
    const frame = element("div", { class: "frame", style: `aspect-ratio: ${picture.width} / ${picture.height}` });
    this.zoom.add(frame);
    this.zoom.addView(picture.view);
    for (const kind of ["pointerdown", "pointermove"] as const)
      frame.addEventListener(kind, (event) => this.readOut(picture.view, event));
    return element("div", { class: "picture" }, frame, element("div", { class: "caption" }, rich(picture.caption)));
  }

  // The left picture as far as this, in percent.
  private split(at: number): void {
    this.curtain.style.clipPath = `inset(0 ${100 - at}% 0 0)`;
    this.divider.style.left = `${at}%`;
    this.divider.setAttribute("aria-valuenow", String(Math.round(at)));
    if (this.mode === "slider") this.line = at;
    const [a, b] = [this.left, this.right].map((select) => this.pictures[Number(select.value)]!.caption.split("\n")[0]!);
    this.now.replaceChildren(rich(this.mode === "slider" ? `left: ${a}; right: ${b}` : this.first ? a! : b!));
  }

  private toggle(): void {
    this.first = !this.first;
    this.split(this.first ? 100 : 0);
  }

  // The line is dragged by its handle, and from anywhere while the pictures are not zoomed: then a drag of those pans.
  private onDown(event: PointerEvent): void {
    if (this.mode === "slider" && event.button === 0 && (this.onHandle(event) || !this.zoom.zoomed)) {
      this.dragged = event.pointerId;
      this.frame.setPointerCapture(event.pointerId);
      this.moveLine(event);
      if (!this.onHandle(event)) event.preventDefault();
      this.divider.focus({ preventScroll: true });
    }
    this.readOutStage(event);
  }

  private onMove(event: PointerEvent): void {
    if (this.dragged === event.pointerId && this.frame.hasPointerCapture(event.pointerId)) this.moveLine(event);
    this.readOutStage(event);
  }

  private onHandle(event: PointerEvent): boolean {
    return event.target instanceof Node && this.divider.contains(event.target);
  }

  private moveLine(event: PointerEvent): void {
    const box = this.frame.getBoundingClientRect();
    this.split(Math.min(100, Math.max(0, ((event.clientX - box.left) / box.width) * 100)));
  }

  private readOutStage(event: PointerEvent): void {
    const under = this.pictures[Number(this.right.value)];
    if (under) this.readOut(under.view, event);
  }

  private readOut(view: HTMLElement, event: PointerEvent): void {
    const box = view.getBoundingClientRect();
    const [u, v] = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    if (u >= 0 && v >= 0 && u < 1 && v < 1) this.options.onPoint?.(u, v);
  }

  // Space and F flip. Left and right move the line of the slider, and go through the pictures elsewhere; up and down always
  // do.
  private onKey(event: KeyboardEvent): void {
    const slides = this.mode === "slider";
    const step = event.shiftKey ? 10 : 2;
    if (event.key === " " || event.key === "f") {
      if (this.mode === "flip") this.toggle();
    } else if (slides && (event.key === "ArrowLeft" || event.key === "ArrowRight")) {
      this.split(Math.min(100, Math.max(0, this.line + (event.key === "ArrowRight" ? step : -step))));
    } else if (slides && (event.key === "Home" || event.key === "End")) {
      this.split(event.key === "Home" ? 0 : 100);
    } else if (event.key.startsWith("Arrow")) {
      const count = this.pictures.length;
      const forward = event.key === "ArrowRight" || event.key === "ArrowDown";
      this.left.value = String((Number(this.left.value) + (forward ? 1 : count - 1)) % count);
      this.arrange();
    } else return;
    event.preventDefault();
  }
}
