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

export function theme(): Theme {
  const chosen = document.documentElement.dataset.theme;
  if (chosen === "light" || chosen === "dark") return chosen;
  return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

function show(value: Theme): void {
  document.documentElement.dataset.theme = value;
  for (const listener of listeners) listener();
}

// Calls back whenever the colours have changed.
export function onThemeChange(listener: () => void): void {
  listeners.push(listener);
}

export function startTheme(button: HTMLButtonElement): void {
  const chosen = stored();
  if (chosen) document.documentElement.dataset.theme = chosen;
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    if (!stored()) listeners.forEach((listener) => listener());
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
  let before: string | undefined;
  addEventListener("beforeprint", () => {
    before = document.documentElement.dataset.theme;
    show("light");
  });
  addEventListener("afterprint", () => {
    if (before) show(before as Theme);
    else {
      delete document.documentElement.dataset.theme;
      listeners.forEach((listener) => listener());
    }
  });
}

export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
