// Pictures in a grid that zoom and pan together.
import { element } from "./dom";
import type { ImagesSection, Picture } from "./report";
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

export function imagesView(images: ImagesSection): HTMLElement {
  const zoom = new SharedZoom();
  const grid = element("div", { class: "pictures", style: `--columns: ${images.columns}` });
  for (const picture of images.pictures) grid.append(pictureView(picture, zoom));
  const hint = element("span", { class: "hint" }, "Double-click to zoom all, drag to pan, shift and double-click to reset.");
  return element("figure", {}, grid,
    element("figcaption", {}, rich(images.caption), " ", hint));
}
