// Pictures that zoom and pan together: in a grid, with a slider between two, or one after the other.
import { element } from "./dom";
import type { ImagesSection, ImagesView, Picture } from "./report";
import { Stage } from "./stage";
import { rich } from "./text";
import { SharedZoom } from "./zoom";

function pictureView(picture: Picture, zoom: SharedZoom): HTMLElement {
  const image = element("img", {
    src: picture.src,
    alt: picture.caption,
    width: String(picture.width),
    height: String(picture.height),
    draggable: "false",
  });
  const frame = element("div", { class: "frame", style: `aspect-ratio: ${picture.width} / ${picture.height}` }, image);
  zoom.add(frame, image);
  return element("div", { class: "picture" }, frame, element("div", { class: "caption" }, rich(picture.caption)));
}

// Buttons of which one is pressed.
function switcher(view: ImagesView, show: (view: ImagesView) => void): HTMLElement {
  const made = element("div", { class: "switcher", role: "group", "aria-label": "View" });
  for (const [name, title] of [["grid", "Side by side"], ["slider", "Slider"], ["flip", "Flip"]] as const) {
    const button = element("button", { type: "button", "aria-pressed": String(name === view) }, title);
    button.addEventListener("click", () => {
      made.querySelectorAll("button").forEach((other) => other.setAttribute("aria-pressed", String(other === button)));
      show(name);
    });
    made.append(button);
  }
  return made;
}

export function imagesView(images: ImagesSection): HTMLElement {
  const zoom = new SharedZoom();
  const grid = element("div", { class: "pictures", style: `--columns: ${images.columns}` });
  for (const picture of images.pictures) grid.append(pictureView(picture, zoom));
  const hint = element("span", { class: "hint" }, "Double-click to zoom all, drag to pan, shift and double-click to reset.");
  const caption = element("figcaption", {}, rich(images.caption), " ", hint);
  if (images.pictures.length < 2) return element("figure", {}, grid, caption);

  const stage = new Stage(images, zoom);
  const show = (view: ImagesView): void => {
    grid.hidden = view !== "grid";
    stage.show(view);
  };
  show(images.view);
  return element("figure", {}, switcher(images.view, show), grid, stage.view, caption);
}
