// Light or dark: as the system has it, or as the reader chose.

type Theme = "light" | "dark";
const key = "montelux-theme";
const listeners: (() => void)[] = [];

function stored(): Theme | null {
  try {
    const value = localStorage.getItem(key);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null; // pages opened from a file may have no storage
  }
}

const ofSystem = (): Theme => (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");

export const theme = (): Theme => document.documentElement.dataset.theme as Theme;

function show(value: Theme): void {
  document.documentElement.dataset.theme = value;
  for (const listener of listeners) listener();
}

// Calls back whenever the colours have changed.
export function onThemeChange(listener: () => void): void {
  listeners.push(listener);
}

export function startTheme(button: HTMLButtonElement): void {
  show(stored() ?? ofSystem());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    if (!stored()) show(ofSystem());
  });
  button.addEventListener("click", () => {
    const next = theme() === "dark" ? "light" : "dark";
    try {
      localStorage.setItem(key, next);
    } catch {
      // the choice holds for this visit
    }
    show(next);
  });
  // Paper is white.
  let before: Theme = "light";
  addEventListener("beforeprint", () => {
    before = theme();
    show("light");
  });
  addEventListener("afterprint", () => show(before));
}

export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
