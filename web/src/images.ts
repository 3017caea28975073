// Pictures of eight bits that are compared.
import { element } from "./dom";
import type { ImagesSection } from "./report";
import { rich } from "./text";
import { Viewer, zoomHint } from "./viewer";

export function imagesView(images: ImagesSection): HTMLElement {
  const viewer = new Viewer({ columns: images.columns, view: images.view });
  viewer.load(images.pictures.map((picture) => ({
    ...picture,
    view: element("img", {
      src: picture.src,
      alt: picture.caption,
      width: String(picture.width),
      height: String(picture.height),
      draggable: "false",
    }),
  })));
  const hint = element("span", { class: "hint" }, zoomHint);
  return element("figure", {}, viewer.element, element("figcaption", {}, rich(images.caption), " ", hint));
}
