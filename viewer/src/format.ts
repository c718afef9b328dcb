// Numbers and colours as the page writes them.

export function fixed(value: number | null | undefined, decimals: number): string {
  return value === null || value === undefined || !Number.isFinite(value) ? '–' : value.toFixed(decimals).replace('-', '−');
}

// Four digits that say something, whatever the size.
export function short(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(2) : value.toPrecision(size >= 1000 ? 5 : 4);
  return text.replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '').replace('-', '−');
}

export function signed(value: number | null | undefined): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  return (value > 0 ? '+' : '') + short(value);
}

export type Rgb = [number, number, number]; // 0 to 1

// A distinct colour for an object's id: steps by the golden angle, so that neighbours differ.
export function colourOfId(id: number): Rgb {
  const hue = (id * 137.508 + 20) % 360;
  const lightness = [0.5, 0.6, 0.42][id % 3] ?? 0.5;
  return hsl(hue, 0.62, lightness);
}

// Bad (0) red, middling yellow, good (1) green.
export function colourOfShare(share: number): Rgb {
  const x = Math.min(1, Math.max(0, share));
  return hsl(x * 130, 0.58, 0.46);
}

// Right (0) pale, off (1) red, yellow between: what is wrong stands out.
export function colourOfError(share: number): Rgb {
  const stops: Rgb[] = [[0.8, 0.84, 0.87], [0.95, 0.76, 0.28], [0.78, 0.14, 0.12]];
  const x = 2 * Math.min(1, Math.max(0, share));
  const from = stops[Math.min(1, Math.floor(x))]!, to = stops[Math.min(1, Math.floor(x)) + 1]!, part = x - Math.min(1, Math.floor(x));
  return [0, 1, 2].map((k) => from[k]! + part * (to[k]! - from[k]!)) as Rgb;
}

function hsl(hue: number, saturation: number, lightness: number): Rgb {
  const f = (n: number): number => {
    const k = (n + hue / 30) % 12;
    return lightness - saturation * Math.min(lightness, 1 - lightness) * Math.max(-1, Math.min(k - 3, 9 - k, 1));
  };
  return [f(0), f(8), f(4)];
}

export function css(rgb: Rgb): string {
  return `rgb(${rgb.map((c) => Math.round(255 * c)).join(' ')})`;
}

export const kTruth: Rgb = [0.09, 0.62, 0.36];
export const kMapped: Rgb = [0.9, 0.31, 0.16];
export const kPath: Rgb = [0.13, 0.45, 0.87];
export const kTruePath: Rgb = [0.45, 0.48, 0.52];
