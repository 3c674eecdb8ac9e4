//! Colours: made in OKLCH, so that no hue shouts, and given to the stage as linear light.

export type Rgb = readonly [number, number, number];

/** Hues of piles in their order: neighbours in the list lie far apart. The same as in drawn pictures. */
const HUES = [235, 55, 150, 350, 95, 290, 190, 20];
/** Beyond the list hues go on by the golden angle, which never comes back to one. */
const GOLDEN_ANGLE = 137.508;
const BEYOND = 181;

/** From OKLCH (Ottosson 2020) to linear light, clipped to what a screen shows. */
export function oklch(lightness: number, chroma: number, hueDeg: number): Rgb {
  const hue = (hueDeg * Math.PI) / 180;
  const [a, b] = [chroma * Math.cos(hue), chroma * Math.sin(hue)];
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const clip = (light: number) => Math.min(Math.max(light, 0), 1);
  return [
    clip(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    clip(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    clip(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** As style sheets write it. */
export function css(colour: Rgb): string {
  const byte = (light: number) => {
    const encoded = light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
    return Math.round(encoded * 255);
  };
  return `rgb(${colour.map(byte).join(" ")})`;
}

export function pileColour(pile: number): Rgb {
  return oklch(0.745, 0.112, HUES[pile] ?? (BEYOND + pile * GOLDEN_ANGLE) % 360);
}

/** A scale from 0 to 1: deep blue by way of teal to a warm yellow, ever lighter. */
export function scaleColour(value: number): Rgb {
  const share = Math.min(Math.max(value, 0), 1);
  return oklch(0.46 + 0.41 * share, 0.115, 275 - 185 * share);
}

/** What a hinge bears over what it is rated for: calm below 1, red from there on. */
export function loadColour(factor: number): Rgb {
  if (factor > 1) return oklch(0.6, 0.2, 27);
  return oklch(0.86 - 0.18 * factor, 0.03 + 0.09 * factor, 160 - 85 * factor);
}

/** A hinge from a room's temperature to the hottest that is heated, °C: cold and pale blue to red. */
export const COLDEST = 20;
export const HOTTEST = 140;

export function heatColour(celsius: number): Rgb {
  const share = Math.min(Math.max((celsius - COLDEST) / (HOTTEST - COLDEST), 0), 1);
  return oklch(0.84 - 0.24 * share, 0.05 + 0.15 * share, 235 - 208 * share ** 0.6);
}

export const NEUTRAL: Rgb = oklch(0.78, 0.008, 250);

export const KINDS: Readonly<Record<string, Rgb>> = {
  "fold 90°": oklch(0.72, 0.13, 45),
  "fold 180°": oklch(0.83, 0.09, 95),
  "fold 270°": oklch(0.66, 0.12, 290),
  bridge: oklch(0.7, 0.11, 200),
};

export const DRIVES: Readonly<Record<string, Rgb>> = {
  sma: oklch(0.72, 0.14, 45),
  servo: oklch(0.68, 0.12, 245),
  spring: oklch(0.74, 0.13, 150),
};
