// How the mean of one pixel settled over the repeats, with its band of confidence.
import { element } from "./dom";
import type { Pixels } from "./pixels";
import { readable } from "./text";
import { color } from "./theme";

// Two-sided 95 % quantiles of Student's t for 1, 2, ... degrees of freedom; the normal one beyond.
const quantiles = [12.71, 4.3, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26, 2.23, 2.2, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.1, 2.09, 2.09];

interface Step { samples: number; mean: number; half: number }

export function runningMean(values: number[], samples: number): Step[] {
  let mean = 0;
  let squares = 0;
  return values.map((value, i) => {
    const off = value - mean;
    mean += off / (i + 1);
    squares += off * (value - mean);
    const half = i === 0 ? Infinity : (quantiles[i - 1] ?? 1.96) * Math.sqrt(squares / i / (i + 1));
    return { samples: samples * (i + 1), mean, half };
  });
}

export function settling(pictures: Pixels[], pixel: number): HTMLElement {
  const made = element("canvas", { class: "settling", width: "760", height: "300", "aria-label": "running means of luminance" });
  const context = made.getContext("2d")!;
  const runs = pictures.map((p) => runningMean(p.repeats.map((repeat) => repeat[pixel]!), p.samples));
  const shown = runs.flat().filter((step) => Number.isFinite(step.half));
  if (shown.length === 0) return element("span", {});
  const truth = pictures[0]!;
  const luminance = 0.2126 * truth.mean[3 * pixel]! + 0.7152 * truth.mean[3 * pixel + 1]! + 0.0722 * truth.mean[3 * pixel + 2]!;
  const settled = shown.filter((_, i) => i > 0);
  const low = Math.min(luminance, ...settled.map((s) => s.mean - s.half));
  const high = Math.max(luminance, ...settled.map((s) => s.mean + s.half));
  const first = Math.min(...shown.map((s) => s.samples));
  const last = Math.max(...shown.map((s) => s.samples));
  const left = 76;
  const bottom = made.height - 40;
  const px = (samples: number): number => left + ((made.width - left - 12) * (samples - first)) / Math.max(1e-9, last - first);
  const py = (value: number): number => 12 + ((bottom - 12) * (high - value)) / Math.max(1e-12, high - low);

  context.font = "20px system-ui, sans-serif";
  context.fillStyle = color("--faint");
  context.fillText(readable(Number(high.toPrecision(3))), 4, 24);
  context.fillText(readable(Number(low.toPrecision(3))), 4, bottom);
  context.fillText(`${readable(first)} … ${readable(last)} samples`, left, made.height - 8);
  context.strokeStyle = color("--faint");
  context.setLineDash([8, 6]);
  context.beginPath();
  context.moveTo(left, py(luminance));
  context.lineTo(made.width - 12, py(luminance));
  context.stroke();
  context.setLineDash([]);
  runs.forEach((run, i) => {
    const steps = run.filter((step) => Number.isFinite(step.half));
    if (steps.length === 0) return;
    const stroke = color(`--series-${i}`);
    context.beginPath();
    steps.forEach((s) => context.lineTo(px(s.samples), py(s.mean + s.half)));
    [...steps].reverse().forEach((s) => context.lineTo(px(s.samples), py(s.mean - s.half)));
    context.fillStyle = `${stroke}2e`;
    context.fill();
    context.beginPath();
    steps.forEach((s) => context.lineTo(px(s.samples), py(s.mean)));
    context.strokeStyle = stroke;
    context.lineWidth = 3;
    context.stroke();
  });
  return made;
}
