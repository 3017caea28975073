// Two pictures at one place, large: with a slider between them, or one after the other.
import { element } from "./dom";
import type { ImagesSection, ImagesView } from "./report";
import type { SharedZoom } from "./zoom";

const title = (caption: string, i: number): string => `${i + 1}. ${caption.split("\n").slice(0, 2).join(", ")}`;

function chooser(images: ImagesSection, chosen: number, label: string): HTMLSelectElement {
  const made = element("select", { "aria-label": label });
  images.pictures.forEach((picture, i) => made.append(element("option", { value: String(i) }, title(picture.caption, i))));
  made.value = String(chosen);
  return made;
}

export class Stage {
  readonly view: HTMLElement;
  private readonly under = element("img", { alt: "", draggable: "false" });
  private readonly over = element("img", { alt: "", draggable: "false" });
  private readonly curtain = element("div", { class: "curtain" }, this.over);
  private readonly divider = element("i", { class: "divider" });
  private readonly left: HTMLSelectElement;
  private readonly right: HTMLSelectElement;
  private readonly flip = element("button", { type: "button" }, "Flip");
  private readonly frame: HTMLElement;
  private mode: ImagesView = "slider";

  constructor(private readonly images: ImagesSection, zoom: SharedZoom) {
    this.left = chooser(images, 0, "left or first picture");
    this.right = chooser(images, 1, "right or second picture");
    const first = images.pictures[0]!;
    this.frame = element("div", { class: "frame", tabindex: "0", style: `aspect-ratio: ${first.width} / ${first.height}` },
      this.under, this.curtain, this.divider);
    this.view = element("div", { class: "stage", hidden: "" },
      element("div", { class: "choose" }, this.left, this.flip, this.right), this.frame);
    zoom.add(this.frame, this.under, this.over);
    this.left.addEventListener("change", () => this.load());
    this.right.addEventListener("change", () => this.load());
    this.flip.addEventListener("click", () => this.toggle());
    this.frame.addEventListener("pointermove", (event) => {
      if (this.mode !== "slider" || event.buttons !== 0) return;
      const box = this.frame.getBoundingClientRect();
      this.split(((event.clientX - box.left) / box.width) * 100);
    });
    this.frame.addEventListener("keydown", (event) => this.onKey(event));
    this.load();
  }

  show(mode: ImagesView): void {
    this.mode = mode;
    this.view.hidden = mode === "grid";
    this.divider.hidden = mode !== "slider";
    this.flip.hidden = mode !== "flip";
    this.split(mode === "slider" ? 50 : 100);
  }

  private load(): void {
    for (const [image, select] of [[this.under, this.right], [this.over, this.left]] as const) {
      const picture = this.images.pictures[Number(select.value)]!;
      image.src = picture.src;
      image.alt = picture.caption;
    }
  }

  // The left picture as far as this, in percent.
  private split(at: number): void {
    this.curtain.style.clipPath = `inset(0 ${100 - at}% 0 0)`;
    this.divider.style.left = `${at}%`;
  }

  private toggle(): void {
    this.split(this.curtain.style.clipPath.includes("100%") ? 100 : 0);
  }

  // Space and F flip; the arrows go through the pictures.
  private onKey(event: KeyboardEvent): void {
    if (event.key === " " || event.key === "f") this.toggle();
    else if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
      const count = this.images.pictures.length;
      const step = event.key === "ArrowRight" ? 1 : count - 1;
      this.left.value = String((Number(this.left.value) + step) % count);
      this.load();
    } else return;
    event.preventDefault();
  }
}
