// A figure as an interactive plot: zoom by dragging, reset by a double click, read-out under the pointer.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { element } from "./dom";
import { join, type Joined } from "./join";
import { placeNames } from "./names";
import { paletteIndex } from "./palette";
import { readout } from "./readout";
import type { Axis, Curve, FigureSection } from "./report";
import { rich } from "./text";
import { color, onThemeChange } from "./theme";
import { linearTicks, logTicks, namedTicks, rangeOf } from "./ticks";

type Range = [number, number];

const seriesColor = (curve: Curve): string => color(`--series-${paletteIndex(curve)}`);
const finite = (values: (number | null)[] | undefined): number[] => (values ?? []).filter((v): v is number => v !== null);
const barStep = (curve: Curve): number => curve.width ?? (curve.x.length > 1 ? curve.x[1]! - curve.x[0]! : 1);

function ranges(figure: FigureSection): { x: Range; y: Range } {
  const bars = figure.curves.some((curve) => curve.mark === "bars");
  const x = figure.curves.flatMap((curve) => {
    const own = finite(curve.x);
    if (curve.mark !== "bars" || own.length < 2) return own;
    return [...own, own[0]! - barStep(curve) / 2, own[own.length - 1]! + barStep(curve) / 2];
  });
  const y = figure.curves.flatMap((curve) => [...finite(curve.y), ...finite(curve.low), ...finite(curve.high)]);
  const bounded = (axis: Axis, range: Range): Range => [axis.low ?? range[0], axis.high ?? range[1]];
  return {
    x: bounded(figure.x, rangeOf(x, figure.x.log, false)),
    y: bounded(figure.y, rangeOf(y, figure.y.log, bars)),
  };
}

const tickFont = "12px system-ui, sans-serif";
const labelSize = 24; // of an axis
const valuesWidth = 56; // beside the plot
const padding: [number, number, number, number] = [10, 14, 0, 0];

function axisOptions(axis: Axis, side: number): uPlot.Axis {
  let labels: string[] = [];
  let angle = 0;
  let size = side === 2 ? 34 : valuesWidth;
  const ticks = (low: number, high: number) =>
    axis.names ? namedTicks(axis.names, low, high) : axis.log ? logTicks(low, high) : linearTicks(low, high);
  const place = (u: uPlot, values: number[], low: number, high: number): void => {
    const left = labelSize + valuesWidth;
    const space = (u.width - left - padding[1]) / (high - low);
    const placed = placeNames(labels, space, left + ((values[0] ?? low) - low) * space, tickFont);
    labels = placed.labels;
    angle = placed.angle;
    size = placed.height + 19;
  };
  return {
    side,
    scale: side === 2 ? "x" : "y",
    label: axis.label,
    labelSize,
    size: () => size,
    rotate: () => angle,
    labelFont: "13px system-ui, sans-serif",
    font: tickFont,
    stroke: () => color("--faint"),
    grid: { stroke: () => color("--grid"), width: 1 },
    ticks: { show: false },
    splits: (u, _axis, low, high) => {
      const made = ticks(low, high);
      labels = made.labels;
      if (axis.names) place(u, made.values, low, high);
      return made.values;
    },
    filter: (_u, splits) => splits,
    values: () => labels,
  };
}

// Bars as wide as the cells of the curve, whatever else stands on the axis.
function barPath(curve: Curve): uPlot.Series.PathBuilder {
  return (u) => {
    const fill = new Path2D();
    const half = 0.46 * barStep(curve);
    const floor = u.scales.y!.distr === 3 ? u.scales.y!.min! : Math.max(0, u.scales.y!.min!);
    const zero = u.valToPos(floor, "y", true);
    curve.x.forEach((x, i) => {
      const y = curve.y[i];
      if (x === null || y === null || y === undefined) return;
      const left = u.valToPos(x - half, "x", true);
      const top = u.valToPos(y, "y", true);
      fill.rect(left, Math.min(top, zero), u.valToPos(x + half, "x", true) - left, Math.abs(zero - top));
    });
    return { stroke: null, fill };
  };
}

function seriesOptions(curve: Curve): uPlot.Series {
  const stroke = (): string => seriesColor(curve);
  const many = curve.x.length > 150;
  const shared: uPlot.Series = { label: curve.name, scale: "y", stroke, spanGaps: true };
  switch (curve.mark) {
    case "points":
      return { ...shared, paths: () => null, points: { show: true, size: many ? 3.5 : 7, width: 0, fill: stroke, stroke } };
    case "bars":
      return { ...shared, paths: barPath(curve), fill: () => `${seriesColor(curve)}73`, width: 0, points: { show: false } };
    case "steps":
      return { ...shared, paths: uPlot.paths.stepped!({ align: 1 }), width: 1.6, points: { show: false } };
    default:
      return { ...shared, width: 1.8, points: { show: false }, ...(curve.mark === "dashes" ? { dash: [7, 5] } : {}) };
  }
}

function clipped(u: uPlot, draw: (context: CanvasRenderingContext2D) => void): void {
  const { left, top, width, height } = u.bbox;
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(left, top, width, height);
  u.ctx.clip();
  draw(u.ctx);
  u.ctx.restore();
}

// A value on the canvas; what a logarithm cannot show lies below it.
function onCanvas(u: uPlot, y: number): number {
  if (u.scales.y!.distr === 3 && y <= 0) return u.bbox.top + 3 * u.bbox.height;
  return u.valToPos(y, "y", true);
}

function drawBand(u: uPlot, curve: Curve, stroke: string): void {
  const shown = curve.x.flatMap((x, i) => {
    const low = curve.low![i];
    const high = curve.high![i];
    if (x === null || low == null || high == null || (u.scales.x!.distr === 3 && x <= 0)) return [];
    return [{ x: u.valToPos(x, "x", true), low: onCanvas(u, low), high: onCanvas(u, high) }];
  });
  clipped(u, (context) => {
    context.beginPath();
    shown.forEach((p) => context.lineTo(p.x, p.high));
    shown.reverse().forEach((p) => context.lineTo(p.x, p.low));
    context.closePath();
    context.fillStyle = `${stroke}2e`;
    context.fill();
  });
}

function drawErrorBars(u: uPlot, curve: Curve, stroke: string): void {
  const cap = 3 * devicePixelRatio;
  clipped(u, (context) => {
    context.strokeStyle = stroke;
    context.setLineDash([]);
    context.lineWidth = 1.2 * devicePixelRatio;
    context.beginPath();
    curve.x.forEach((x, i) => {
      const low = curve.low![i];
      const high = curve.high![i];
      if (x === null || low == null || high == null) return;
      const px = u.valToPos(x, "x", true);
      for (const y of [onCanvas(u, low), onCanvas(u, high)]) {
        context.moveTo(px - cap, y);
        context.lineTo(px + cap, y);
      }
      context.moveTo(px, onCanvas(u, low));
      context.lineTo(px, onCanvas(u, high));
    });
    context.stroke();
  });
}

// Bands lie under the curves, error bars over them.
function drawSpread(u: uPlot, curves: Curve[], bands: boolean): void {
  curves.forEach((curve, i) => {
    if (!curve.low || !curve.high || !u.series[i + 1]!.show) return;
    const onPoints = curve.mark === "points" || curve.mark === "bars";
    if (onPoints === bands) return;
    if (bands) drawBand(u, curve, seriesColor(curve));
    else drawErrorBars(u, curve, seriesColor(curve));
  });
}

interface Size { width: number; height: number }

// The style sheet sizes a plot's place before the plot is made, so that nothing below it moves.
const sizeOf = (host: HTMLElement): Size => ({ width: host.clientWidth, height: host.clientHeight });
// On a page of A4 between margins of 16 mm, in CSS pixels.
const sizeOnPaper = (figure: FigureSection): Size => (figure.square ? { width: 320, height: 292 } : { width: 660, height: 280 });

function plotOptions(figure: FigureSection, joined: Joined, size: Size): uPlot.Options {
  const full = ranges(figure);
  const reset = (u: uPlot) => {
    u.batch(() => {
      u.setScale("x", { min: full.x[0], max: full.x[1] });
      u.setScale("y", { min: full.y[0], max: full.y[1] });
    });
  };
  return {
    width: size.width,
    height: size.height,
    pxAlign: false,
    padding,
    legend: { show: false },
    scales: {
      x: { time: false, distr: figure.x.log ? 3 : 1, range: () => full.x },
      y: { distr: figure.y.log ? 3 : 1, range: () => full.y },
    },
    axes: [axisOptions(figure.x, 2), axisOptions(figure.y, 3)],
    series: [{}, ...figure.curves.map((curve) => seriesOptions(curve))],
    cursor: {
      drag: { x: true, y: true, uni: 24 },
      points: { show: false },
      bind: { dblclick: (u) => () => (reset(u), null) },
    },
    hooks: {
      drawAxes: [(u) => drawSpread(u, figure.curves, true)],
      draw: [(u) => drawSpread(u, figure.curves, false)],
    },
    plugins: [readout(figure, joined)],
  };
}

// A name for each curve; a click hides and shows it.
function legend(figure: FigureSection, plot: () => uPlot | undefined): HTMLElement {
  const made = element("div", { class: "legend" });
  figure.curves.forEach((curve, i) => {
    if (!curve.name) return;
    const key = element("i", { class: `key ${curve.mark}`, style: `--key: var(--series-${paletteIndex(curve)})` });
    const button = element("button", { type: "button", "aria-pressed": "true" }, key, rich(curve.name));
    button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", String(shown));
      plot()?.setSeries(i + 1, { show: shown });
    });
    made.append(button);
  });
  return made;
}

export function figureView(figure: FigureSection): HTMLElement {
  const host = element("div", { class: figure.square ? "plot square" : figure.x.names ? "plot named" : "plot" });
  const joined = join(figure.curves, figure.x.log);
  let plot: uPlot | undefined;
  const hint = element("span", { class: "hint" }, "Drag to zoom, double-click to reset.");
  const caption = element("figcaption", {}, rich(figure.caption), " ", hint);
  const made = element("figure", { class: figure.square ? "half" : "" }, legend(figure, () => plot), host, caption);

  const draw = (size: Size): void => {
    if (size.width === 0) return;
    const hidden = plot?.series.map((series) => series.show === false) ?? [];
    plot?.destroy();
    plot = new uPlot(plotOptions(figure, joined, size), [joined.x, ...joined.columns] as uPlot.AlignedData, host);
    hidden.forEach((off, i) => off && plot!.setSeries(i, { show: false }));
  };
  // Plots are made when they come near to the window, and again at another width or in other colours.
  let width = 0;
  let printing = false;
  new IntersectionObserver(
    (entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      new ResizeObserver(() => {
        if (printing) return;
        if (host.clientWidth !== width) draw(sizeOf(host));
        width = host.clientWidth;
      }).observe(host);
    },
    { rootMargin: "600px" },
  ).observe(host);
  onThemeChange(() => plot && !printing && draw(sizeOf(host)));
  addEventListener("beforeprint", () => {
    printing = true;
    draw(sizeOnPaper(figure));
  });
  addEventListener("afterprint", () => {
    printing = false;
    draw(sizeOf(host));
  });
  return made;
}
