import type { Curve } from "./report";

// The place of a curve's colour among those of the style sheet, from 1 on.
export const paletteIndex = (curve: Curve): number => (curve.color % 8) + 1;
