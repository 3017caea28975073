// Pictures in linear values: unpacking them, and showing them on a canvas.
import type { MeasuredPicture } from "./report";

export interface Pixels {
  name: string;
  width: number;
  height: number;
  samples: number; // a pixel, in each repeat
  set: string;
  channels: 1 | 3;
  mean: Float32Array; // so many a pixel
  error: Float32Array; // likewise; empty: exact
  repeats: Float32Array[]; // luminance, one per pixel
}

// The number with these 16 bits (IEEE 754 binary16).
export function halfToNumber(bits: number): number {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15));
}

function unpack(text: string): Float32Array {
  const bytes = atob(text);
  const values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; ++i)
    values[i] = halfToNumber(bytes.charCodeAt(2 * i) | (bytes.charCodeAt(2 * i + 1) << 8));
  return values;
}

export function unpackPicture(picture: MeasuredPicture): Pixels {
  const mean = unpack(picture.mean);
  return {
    name: picture.name,
    width: picture.width,
    height: picture.height,
    samples: picture.samples ?? 1,
    set: picture.set,
    channels: mean.length === picture.width * picture.height ? 1 : 3,
    mean,
    error: unpack(picture.error),
    repeats: picture.repeats.map(unpack),
  };
}

const toDisplay = (linear: number): number => {
  const x = Math.min(1, Math.max(0, linear));
  return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
};

function paint(canvas: HTMLCanvasElement, width: number, height: number, color: (pixel: number) => [number, number, number]): void {
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext("2d")!;
  const image = context.createImageData(width, height);
  for (let p = 0; p < width * height; ++p) {
    const [r, g, b] = color(p);
    image.data.set([r, g, b, 255], 4 * p);
  }
  context.putImageData(image, 0, 0);
}

// The picture through the sRGB curve, brighter by `stops`.
export function paintPicture(canvas: HTMLCanvasElement, pixels: Pixels, stops: number): void {
  const gain = 2 ** stops;
  const { mean, channels } = pixels;
  const component = (p: number, c: number): number => toDisplay(gain * mean[channels === 1 ? p : 3 * p + c]!);
  paint(canvas, pixels.width, pixels.height, (p) => [component(p, 0), component(p, 1), component(p, 2)]);
}

// Black, purple, orange, pale yellow over [0, 1].
function falseColor(x: number): [number, number, number] {
  const stops = [[0, 0, 4], [86, 15, 109], [187, 55, 84], [249, 142, 9], [252, 255, 164]];
  const at = Math.min(0.9999, Math.max(0, x)) * (stops.length - 1);
  const i = Math.floor(at);
  const mix = (c: number): number => stops[i]![c]! + (at - i) * (stops[i + 1]![c]! - stops[i]![c]!);
  return [mix(0), mix(1), mix(2)];
}

// How far the picture is from the reference: the root of the squared error over reference^2 + 0.01, on a scale of
// logarithms from 1 % to 10 times, brighter by `stops`.
export function paintError(canvas: HTMLCanvasElement, pixels: Pixels, reference: Pixels, stops: number): void {
  paint(canvas, pixels.width, pixels.height, (p) => {
    let sum = 0;
    for (let c = 3 * p; c < 3 * p + 3; ++c) {
      const truth = reference.mean[c]!;
      sum += (pixels.mean[c]! - truth) ** 2 / (truth * truth + 0.01) / 3;
    }
    return falseColor((Math.log10(Math.sqrt(sum) * 2 ** stops + 1e-12) + 2) / 3);
  });
}
