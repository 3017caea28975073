// The form of the data in the page, as src/lab/report/json.cpp writes it.

export type Mark = "line" | "dashes" | "points" | "bars" | "steps";
export type Value = number | null;

export interface Curve {
  name: string;
  mark: Mark;
  x: Value[];
  y: Value[];
  low?: Value[];
  high?: Value[];
  color: number; // counted through the palette
  width?: number; // of bars
}

export interface Axis {
  label: string;
  log: boolean;
  low?: number;
  high?: number;
  names?: string[]; // of the places 1, 2, ...
}

export interface TextSection { kind: "text"; text: string }
export interface FormulaSection { kind: "formula"; latex: string; source: string }
export interface TableSection {
  kind: "table";
  name: string;
  caption: string;
  columns: string[];
  rows: (string | Value)[][];
}
export interface FactsSection { kind: "facts"; rows: [string, string][] }
export interface FigureSection {
  kind: "figure";
  name: string;
  caption: string;
  x: Axis;
  y: Axis;
  square: boolean;
  curves: Curve[];
}
export type ImagesView = "grid" | "slider" | "flip";
export interface Picture { caption: string; width: number; height: number; src: string }
export interface ImagesSection {
  kind: "images";
  name: string;
  caption: string;
  columns: number;
  view: ImagesView;
  pictures: Picture[];
}
// Values are 16-bit floats, little end first, in base 64: three a pixel (mean, error) or one (repeats; mean and error of
// pictures of one channel).
export interface MeasuredPicture {
  name: string;
  width: number;
  height: number;
  samples: Value;
  set: string;
  mean: string;
  error: string;
  repeats: string[];
}
export interface ComparisonSection { kind: "comparison"; name: string; caption: string; pictures: MeasuredPicture[] }
export interface VerdictSection { kind: "verdict"; claim: string; detail: string; passed: boolean }
export interface CommandsSection { kind: "commands"; lines: string[] }

export type Section =
  | TextSection
  | FormulaSection
  | TableSection
  | FactsSection
  | FigureSection
  | ImagesSection
  | ComparisonSection
  | VerdictSection
  | CommandsSection;

export interface Report {
  name: string;
  title: string;
  group: string;
  passed: boolean;
  sections: Section[];
}

export interface ReportSet {
  title: string;
  subtitle: string;
  reports: Report[];
}
