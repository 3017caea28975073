// What the curves are worth under the pointer.
import type uPlot from "uplot";
import { element } from "./dom";
import { paletteIndex } from "./palette";
import type { Joined } from "./join";
import type { Curve, FigureSection } from "./report";
import { readable, rich } from "./text";

interface Found { curve: Curve; point: number; distance: number }

const reach = 40; // pixels

// For each curve the point nearest to the pointer; in x alone for lines and bars.
function nearest(u: uPlot, figure: FigureSection): Found[] {
  const left = u.cursor.left!;
  const top = u.cursor.top!;
  const found: Found[] = [];
  figure.curves.forEach((curve, i) => {
    if (!curve.name || !u.series[i + 1]!.show) return;
    let best: Found | null = null;
    curve.x.forEach((x, point) => {
      const y = curve.y[point];
      if (x === null || y == null || (figure.x.log && x <= 0)) return;
      const dx = Math.abs(u.valToPos(x, "x") - left);
      const dy = Math.abs(u.valToPos(y, "y") - top);
      const scattered = curve.mark === "points" && curve.x.length > 150;
      const distance = scattered ? Math.hypot(dx, dy) : dx + 1e-3 * dy;
      if (distance <= reach && (!best || distance < best.distance)) best = { curve, point, distance };
    });
    if (best) found.push(best);
  });
  return found;
}

function lineOf({ curve, point }: Found, withX: boolean): HTMLElement {
  const key = element("i", { class: `key ${curve.mark}`, style: `--key: var(--series-${paletteIndex(curve)})` });
  const spread =
    curve.low?.[point] != null ? ` (${readable(curve.low[point]!)} … ${readable(curve.high![point]!)})` : "";
  const place = withX ? `${readable(curve.x[point]!)}, ` : "";
  return element(
    "div",
    { class: "row" },
    key,
    element("span", { class: "name" }, rich(curve.name)),
    element("span", { class: "value" }, `${place}${readable(curve.y[point]!)}${spread}`),
  );
}

export function readout(figure: FigureSection, joined: Joined): uPlot.Plugin {
  const box = element("div", { class: "readout", role: "status" });
  const hide = (): void => box.classList.remove("shown");
  return {
    hooks: {
      init: (u) => {
        u.over.append(box);
        u.over.addEventListener("mouseleave", hide);
      },
      setCursor: (u) => {
        const left = u.cursor.left ?? -1;
        if (left < 0 || joined.x.length === 0) return hide();
        const found = nearest(u, figure);
        if (found.length === 0) return hide();
        const first = found.reduce((a, b) => (b.distance < a.distance ? b : a));
        const x = first.curve.x[first.point]!;
        // One x for all where the curves share it, else each with its own.
        const name = figure.x.names?.[Math.round(x) - 1];
        const shared = found.every((f) => (name ? Math.round(f.curve.x[f.point]!) === Math.round(x) : f.curve.x[f.point] === x));
        const head = shared ? [element("div", { class: "head" }, `${figure.x.label}: ${name ?? readable(x)}`)] : [];
        box.replaceChildren(...head, ...found.map((f) => lineOf(f, !shared)));
        box.classList.add("shown");
        const right = left > u.over.clientWidth / 2;
        box.style.left = right ? "auto" : `${left + 16}px`;
        box.style.right = right ? `${u.over.clientWidth - left + 16}px` : "auto";
        box.style.top = `${Math.min(u.cursor.top! + 8, Math.max(0, u.over.clientHeight - box.clientHeight - 4))}px`;
      },
    },
  };
}
