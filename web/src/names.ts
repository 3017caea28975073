// Names along an axis, placed so that no two overlap: side by side, else turned, shortened where even that is too long.

export interface PlacedNames {
  labels: string[];
  angle: number; // degrees, as uPlot turns labels: the end of a name stands at its place
  height: number; // that they take
}

const lineHeight = 15;
const gap = 8;
const steepest = 120; // the longest name on end

const measuring = document.createElement("canvas").getContext("2d")!;

function widthOf(text: string, font: string): number {
  measuring.font = font;
  return measuring.measureText(text).width;
}

// "emission", "environment" of "technique_emission", "technique_environment": what the label of the axis says anyway.
export function withoutSharedStart(names: string[]): string[] {
  if (names.length < 2) return names;
  let shared = 0;
  while (names.every((name) => shared < name.length && name[shared] === names[0]![shared])) ++shared;
  const start = names[0]!.lastIndexOf("_", shared - 1) + 1;
  return shared > 0 && names.every((name) => name.length > start) ? names.map((name) => name.slice(start)) : names;
}

function shortened(name: string, room: number, font: string): string {
  if (widthOf(name, font) <= room) return name;
  let kept = name.length - 1;
  while (kept > 1 && widthOf(`${name.slice(0, kept)}…`, font) > room) --kept;
  return `${name.slice(0, kept)}…`;
}

// Places names at equal distances of `space` pixels, the first of them `before` pixels from the left edge of the plot.
export function placeNames(names: string[], space: number, before: number, font: string): PlacedNames {
  const widest = (labels: string[]): number => Math.max(0, ...labels.map((label) => widthOf(label, font)));
  const short = withoutSharedStart(names);
  for (const labels of [names, short])
    if (widest(labels) + gap <= space) return { labels, angle: 0, height: lineHeight };
  const slope = Math.SQRT1_2; // of 45 degrees
  if (space * slope >= lineHeight) {
    const labels = short.map((name, i) => shortened(name, Math.min(steepest, (before + i * space) / slope - lineHeight), font));
    return { labels, angle: 45, height: slope * (widest(labels) + lineHeight) };
  }
  // On end; where there are more than fit, every second, third, ... has its name.
  const step = Math.ceil(lineHeight / space);
  const labels = short.map((name, i) => (i % step === 0 ? shortened(name, steepest, font) : ""));
  return { labels, angle: 90, height: widest(labels) };
}
