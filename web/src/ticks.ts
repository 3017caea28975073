// Ticks of linear and logarithmic axes; the same as src/lab/report/axis_scale.cpp for paper.
import { powerOfTen } from "./text";

export interface Ticks { values: number[]; labels: string[] }

function decade(exponent: number): string {
  return exponent >= -2 && exponent <= 3 ? String(Number((10 ** exponent).toPrecision(1))) : powerOfTen(exponent);
}

export function logTicks(low: number, high: number): Ticks {
  const first = Math.floor(Math.log10(low));
  const last = Math.ceil(Math.log10(high));
  if (Math.log10(high / low) < 0.7) return linearTicks(low, high);
  const few = Math.log10(high / low) < 2.2;
  const step = Math.max(1, Math.floor((last - first) / 7));
  const ticks: Ticks = { values: [], labels: [] };
  for (let e = first; e <= last; ++e) {
    for (let digit = 1; digit < (last - first > 5 ? 2 : 10); ++digit) {
      const value = digit * 10 ** e;
      if (value < low * (1 - 1e-9) || value > high * (1 + 1e-9)) continue;
      const named = digit === 1 ? e % step === 0 : few && (digit === 2 || digit === 5);
      if (!named && step > 1) continue;
      ticks.values.push(value);
      ticks.labels.push(!named ? "" : digit === 1 ? decade(e) : String(Number(value.toPrecision(3))));
    }
  }
  return ticks;
}

export function linearTicks(low: number, high: number, count = 6): Ticks {
  const raw = (high - low) / count;
  const unit = 10 ** Math.floor(Math.log10(raw));
  const ratio = raw / unit;
  const step = unit * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
  const ticks: Ticks = { values: [], labels: [] };
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    const value = Number((k * step).toPrecision(12));
    ticks.values.push(value);
    ticks.labels.push(String(value).replace(/^-/, "−"));
  }
  return ticks;
}

// Names at the places 1, 2, ....
export function namedTicks(names: string[], low: number, high: number): Ticks {
  const ticks: Ticks = { values: [], labels: [] };
  names.forEach((name, i) => {
    if (i + 1 < low || i + 1 > high) return;
    ticks.values.push(i + 1);
    ticks.labels.push(name);
  });
  return ticks;
}

// The range that an axis shows.
export function rangeOf(values: number[], log: boolean, fromZero: boolean): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const v of values) {
    if (!Number.isFinite(v) || (log && v <= 0)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  if (!(low <= high)) return log ? [0.1, 1] : [0, 1];
  if (log) {
    const margin = Math.max((high / low) ** 0.04, 1.02);
    return [low / margin, high * margin];
  }
  if (fromZero) {
    low = Math.min(low, 0);
    high = Math.max(high, 0);
  }
  const margin = high > low ? 0.04 * (high - low) : Math.max(0.5 * Math.abs(high), 0.5);
  return [fromZero && low === 0 ? 0 : low - margin, high + margin];
}
