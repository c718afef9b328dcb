// Small charts as SVG: lines, stacked areas, bars. Colours are classes' (style.css), so that they follow the page's theme.
import { h, s } from './dom';
import { short } from './format';

export interface Scale {
  low: number;
  high: number;
  ticks: number[];
}

// Round steps that cover [low, high].
export function niceScale(low: number, high: number, count = 5): Scale {
  if (!(high > low)) {
    const pad = Math.abs(low) * 0.1 || 1;
    return niceScale(low - pad, low + pad, count);
  }
  const raw = (high - low) / count;
  const decade = 10 ** Math.floor(Math.log10(raw));
  const step = ([1, 2, 2.5, 5, 10].find((m) => m * decade >= raw) ?? 10) * decade;
  const from = Math.floor(low / step + 1e-9) * step, to = Math.ceil(high / step - 1e-9) * step;
  const ticks: number[] = [];
  for (let i = 0; from + i * step <= to + step * 1e-6; ++i) ticks.push(Number((from + i * step).toPrecision(12)));
  return { low: from, high: to, ticks };
}

export const kWidth = 560, kLeft = 52, kRight = 12, kTop = 10, kBottom = 36;

export class Frame {
  readonly svg: SVGSVGElement;
  readonly plot: SVGGElement;
  constructor(
    readonly x: Scale,
    readonly y: Scale,
    xLabel: string,
    yLabel: string,
    readonly height = 210,
    xTicks = true,
  ) {
    this.svg = s('svg', { viewBox: `0 0 ${kWidth} ${height}`, class: 'chart', role: 'img', 'aria-label': `${yLabel} over ${xLabel}` });
    for (const tick of y.ticks) {
      const at = this.py(tick);
      this.svg.append(s('line', { class: 'grid', x1: kLeft, x2: kWidth - kRight, y1: at, y2: at }), s('text', { class: 'tick', x: kLeft - 6, y: at + 3.5, 'text-anchor': 'end' }, short(tick)));
    }
    if (xTicks) {
      for (const tick of x.ticks) {
        const at = this.px(tick);
        this.svg.append(s('line', { class: 'grid', x1: at, x2: at, y1: kTop, y2: height - kBottom }), s('text', { class: 'tick', x: at, y: height - kBottom + 14, 'text-anchor': 'middle' }, short(tick)));
      }
    }
    this.svg.append(
      s('text', { class: 'axis', x: (kLeft + kWidth - kRight) / 2, y: height - 4, 'text-anchor': 'middle' }, xLabel),
      s('text', { class: 'axis', x: 0, y: 0, 'text-anchor': 'middle', transform: `translate(11 ${(kTop + height - kBottom) / 2}) rotate(-90)` }, yLabel),
    );
    this.plot = s('g');
    this.svg.append(this.plot);
  }
  px(value: number): number {
    return kLeft + ((value - this.x.low) / (this.x.high - this.x.low)) * (kWidth - kLeft - kRight);
  }
  py(value: number): number {
    return this.height - kBottom - ((value - this.y.low) / (this.y.high - this.y.low)) * (this.height - kTop - kBottom);
  }
  // The value on the x axis under a pointer.
  valueAt(event: MouseEvent): number {
    const box = this.svg.getBoundingClientRect();
    const inside = ((event.clientX - box.left) / box.width) * kWidth;
    return this.x.low + ((inside - kLeft) / (kWidth - kLeft - kRight)) * (this.x.high - this.x.low);
  }
}

export interface TimeChart {
  element: HTMLElement;
  setTime: (t: number) => void;
}

// A line over time with a mark at the slider's time; a click asks for another time.
export function timeChart(points: [number, number][], yLabel: string, onTime: (t: number) => void): TimeChart {
  const frame = new Frame(niceScale(0, Math.max(points.at(-1)?.[0] ?? 1, 1e-3), 8), niceScale(0, Math.max(...points.map((p) => p[1]), 1e-6), 4), 'time (s)', yLabel);
  frame.plot.append(s('path', { class: 'line', d: pathOf(points.map(([t, v]) => [frame.px(t), frame.py(v)])) }));
  return withCursor(frame, onTime, (t) => {
    const near = points.reduce((best, p) => (Math.abs(p[0] - t) < Math.abs(best[0] - t) ? p : best), points[0] ?? [0, 0]);
    return `${short(near[1])} at ${near[0].toFixed(1)} s`;
  });
}

// Stages on top of each other: rows of [t, first, second, ...].
export function stackedChart(rows: number[][], names: string[], yLabel: string, onTime: (t: number) => void): TimeChart {
  const totals = rows.map((row) => row.slice(1).reduce((a, b) => a + b, 0));
  const sorted = [...totals].sort((a, b) => a - b);
  // One slow frame would flatten all others: it is cut off.
  const top = Math.min(sorted.at(-1) ?? 1, 1.6 * (sorted[Math.floor(0.98 * sorted.length)] ?? 1));
  const frame = new Frame(niceScale(0, Math.max(rows.at(-1)?.[0] ?? 1, 1e-3), 8), niceScale(0, Math.max(top, 1e-3), 4), 'time (s)', yLabel);
  let below = rows.map(() => 0);
  names.forEach((_, k) => {
    const above = rows.map((row, i) => (below[i] ?? 0) + (row[k + 1] ?? 0));
    const y = (v: number): number => frame.py(Math.min(v, frame.y.high));
    const up = rows.map((row, i): [number, number] => [frame.px(row[0] ?? 0), y(above[i] ?? 0)]);
    const down = rows.map((row, i): [number, number] => [frame.px(row[0] ?? 0), y(below[i] ?? 0)]).reverse();
    frame.plot.append(s('path', { class: `area c${k}`, d: `${pathOf([...up, ...down])}Z` }));
    below = above;
  });
  const chart = withCursor(frame, onTime, (t) => {
    const i = rows.reduce((best, row, index) => (Math.abs((row[0] ?? 0) - t) < Math.abs((rows[best]?.[0] ?? 0) - t) ? index : best), 0);
    return `${short(totals[i])} ms at ${(rows[i]?.[0] ?? 0).toFixed(1)} s`;
  });
  chart.element.append(h('p', { class: 'legend' }, ...names.map((name, k) => h('span', {}, h('i', { class: `swatch c${k}` }), name))));
  return chart;
}

function withCursor(frame: Frame, onTime: (t: number) => void, say: (t: number) => string): TimeChart {
  const cursor = s('line', { class: 'cursor', x1: kLeft, x2: kLeft, y1: kTop, y2: frame.height - kBottom });
  const reading = s('text', { class: 'reading', x: kWidth - kRight - 4, y: kTop + 12, 'text-anchor': 'end' });
  frame.svg.append(cursor, reading);
  frame.svg.addEventListener('pointermove', (event) => (reading.textContent = say(frame.valueAt(event))));
  frame.svg.addEventListener('pointerleave', () => (reading.textContent = ''));
  frame.svg.addEventListener('click', (event) => onTime(frame.valueAt(event)));
  return {
    element: h('div', { class: 'chartbox' }, frame.svg),
    setTime: (t) => {
      const at = String(frame.px(Math.min(Math.max(t, frame.x.low), frame.x.high)));
      cursor.setAttribute('x1', at);
      cursor.setAttribute('x2', at);
    },
  };
}

// Bars with a caption each.
export function bars(values: number[], labels: string[], yLabel: string, xLabel: string): HTMLElement {
  const frame = new Frame({ low: 0, high: values.length, ticks: [] }, niceScale(0, Math.max(...values, 1), 4), xLabel, yLabel, 190, false);
  const every = Math.ceil(labels.length / 10);
  values.forEach((value, i) => {
    const x = frame.px(i + 0.08), width = frame.px(i + 0.92) - x, y = frame.py(value);
    frame.plot.append(s('rect', { class: 'bar', x, y, width, height: Math.max(0, frame.py(0) - y) }, s('title', {}, `${labels[i] ?? ''}: ${value}`)));
    if (i % every === 0) frame.svg.append(s('text', { class: 'tick', x: frame.px(i + 0.5), y: frame.height - kBottom + 14, 'text-anchor': 'middle' }, labels[i] ?? ''));
  });
  return h('div', { class: 'chartbox' }, frame.svg);
}

export function pathOf(points: [number, number][]): string {
  return points.map(([x, y], i) => `${i === 0 ? 'M' : 'L'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');
}
