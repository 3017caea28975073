// Curves on one ascending x, as the plot wants them: where a curve has no point there is a gap.
import type { Curve, Value } from "./report";

export interface Joined {
  x: number[];
  columns: Value[][];
  rows: number[][]; // for each curve, the row of each of its points
}

export function join(curves: Curve[], log: boolean): Joined {
  const places: { x: number; curve: number; point: number }[] = [];
  curves.forEach((curve, c) =>
    curve.x.forEach((x, p) => {
      if (x !== null && (!log || x > 0)) places.push({ x, curve: c, point: p });
    }),
  );
  places.sort((a, b) => a.x - b.x);
  const joined: Joined = { x: [], columns: curves.map(() => []), rows: curves.map(() => []) };
  for (const { x, curve, point } of places) {
    // One row serves all curves that have a point at this x; a curve's second point there takes a row of its own.
    const last = joined.x.length - 1;
    const fresh = last < 0 || joined.x[last] !== x || joined.columns[curve]![last] !== undefined;
    const row = fresh ? joined.x.push(x) - 1 : last;
    joined.columns[curve]![row] = curves[curve]!.y[point] ?? null;
    joined.rows[curve]![point] = row;
  }
  for (const column of joined.columns)
    for (let row = 0; row < joined.x.length; ++row) if (column[row] === undefined) column[row] = null;
  return joined;
}
