//! Light and dark: as the system says, until somebody chooses.

export interface Theme {
  readonly background: string;
  /** What inner sides fade to. */
  readonly paper: string;
  readonly accent: string;
  /** How dark a shadow on the ground is. */
  readonly shadow: number;
  /** The light that the ground throws back. */
  readonly bounce: string;
  readonly sky: number;
  readonly sun: number;
}

export const THEMES: Readonly<Record<"light" | "dark", Theme>> = {
  light: {
    background: "#f5f4f0", paper: "#ffffff", accent: "#d9480f", shadow: 0.13, bounce: "#e6e2d8", sky: 2.1, sun: 1.45,
  },
  dark: {
    background: "#16181c", paper: "#d9dce2", accent: "#ffb454", shadow: 0.5, bounce: "#8d94a3", sky: 1.95, sun: 1.5,
  },
};

const KEY = "zygote.theme";

export class ThemeChoice {
  private readonly system = matchMedia("(prefers-color-scheme: dark)");
  private chosen: "light" | "dark" | undefined;

  constructor(private readonly changed: (theme: Theme) => void, fixed?: "light" | "dark") {
    this.chosen = fixed ?? remembered();
    this.system.addEventListener("change", () => this.apply());
  }

  get name(): "light" | "dark" {
    return this.chosen ?? (this.system.matches ? "dark" : "light");
  }

  toggle(): void {
    this.chosen = this.name === "dark" ? "light" : "dark";
    try {
      localStorage.setItem(KEY, this.chosen);
    } catch {
      // A browser may keep nothing; the choice holds as long as the page.
    }
    this.apply();
  }

  apply(): void {
    document.documentElement.dataset["theme"] = this.name;
    this.changed(THEMES[this.name]);
  }
}

function remembered(): "light" | "dark" | undefined {
  try {
    const word = localStorage.getItem(KEY);
    return word === "light" || word === "dark" ? word : undefined;
  } catch {
    return undefined;
  }
}
