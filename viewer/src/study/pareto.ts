// Two measures against each other, a point a candidate that was run.
import type { Candidate, Measure, StudyData } from '../data';
import { Frame, niceScale, pathOf } from '../chart';
import { h, s, section } from '../dom';
import { short } from '../format';
import { meanOf, unitOf, type Choice } from './page';

export class Pareto {
  readonly element: HTMLElement;
  private readonly plot = h('div', { class: 'chartbox' });
  private readonly x: HTMLSelectElement;
  private readonly y: HTMLSelectElement;
  private readonly words = h('p', { class: 'note', 'aria-live': 'polite' });

  constructor(private readonly data: StudyData, private readonly choice: Choice) {
    const { measures, pareto } = data.study;
    const axis = (label: string, wanted: string | undefined): HTMLSelectElement => {
      const select = h('select', { 'aria-label': label }, ...measures.map((m) => h('option', { value: m.name, selected: m.name === wanted }, m.name.replaceAll('_', ' '))));
      select.addEventListener('change', () => this.draw());
      return select;
    };
    this.x = axis('Across', pareto?.measures[1] ?? measures[1]?.name);
    this.y = axis('Up', pareto?.measures[0] ?? measures[0]?.name);
    this.element = section('What is traded for what', h('p', { class: 'axes' }, h('label', {}, 'up ', this.y), h('label', {}, 'across ', this.x)), this.plot, this.words);
    choice.when(() => this.draw());
  }

  private draw(): void {
    const { study } = this.data;
    const measure = (select: HTMLSelectElement): Measure | undefined => study.measures.find((m) => m.name === select.value);
    const mx = measure(this.x), my = measure(this.y);
    if (!mx || !my) return;
    const points = study.candidates.flatMap((candidate): { candidate: Candidate; x: number; y: number }[] => {
      const x = meanOf(candidate, mx.name), y = meanOf(candidate, my.name);
      return candidate.state === 'run' && x !== null && y !== null ? [{ candidate, x, y }] : [];
    });
    if (points.length === 0) {
      this.plot.replaceChildren(h('p', { class: 'note' }, 'No candidate has both measures.'));
      return;
    }
    const span = (values: number[]): [number, number] => [Math.min(...values), Math.max(...values)];
    const name = (m: Measure): string => `${m.name.replaceAll('_', ' ')}${unitOf(m)}, ${m.better ?? 'more'} is better`;
    const frame = new Frame(niceScale(...span(points.map((p) => p.x))), niceScale(...span(points.map((p) => p.y))), name(mx), name(my), 320);
    const front = frontOf(points, mx, my);
    frame.plot.append(s('path', { class: 'front', d: pathOf(front.map((p) => [frame.px(p.x), frame.py(p.y)])) }));
    for (const point of points) {
      const { candidate } = point;
      const kind = ['point', front.includes(point) ? 'front' : '', candidate.feasible === false ? 'off' : '', candidate.number === study.best ? 'best' : '', candidate.number === study.baseline ? 'baseline' : '', candidate === this.choice.candidate ? 'chosen' : ''].join(' ');
      const dot = s('circle', { class: kind, cx: frame.px(point.x), cy: frame.py(point.y), r: candidate === this.choice.candidate ? 8 : 6, tabindex: 0, role: 'button', 'aria-label': candidate.name, 'data-candidate': candidate.name }, s('title', {}, `${candidate.name}: ${short(point.x)}, ${short(point.y)}`));
      const say = (): void => void (this.words.textContent = `${candidate.name}: ${my.name.replaceAll('_', ' ')} ${short(point.y)}, ${mx.name.replaceAll('_', ' ')} ${short(point.x)}; ${study.factors.map((f) => `${f.name} ${String(candidate.values[f.name] ?? '–')}`).join(', ')}`);
      dot.addEventListener('pointerenter', say);
      dot.addEventListener('focus', say);
      dot.addEventListener('click', () => this.choice.choose(candidate));
      dot.addEventListener('keydown', (event) => {
        if (event.key === 'Enter') this.choice.choose(candidate);
      });
      frame.plot.append(dot);
      if (candidate.number === study.best || candidate.number === study.baseline || candidate === this.choice.candidate) {
        frame.plot.append(s('text', { class: 'name', x: frame.px(point.x) + 10, y: frame.py(point.y) - 8 }, candidate.name));
      }
    }
    this.plot.replaceChildren(frame.svg, legend());
  }
}

// Those that no other beats in both; along the front.
function frontOf<P extends { x: number; y: number; candidate: Candidate }>(points: P[], mx: Measure, my: Measure): P[] {
  const sx = mx.better === 'less' ? -1 : 1, sy = my.better === 'less' ? -1 : 1;
  const feasible = points.filter((p) => p.candidate.feasible !== false);
  const beats = (a: P, b: P): boolean => sx * a.x >= sx * b.x && sy * a.y >= sy * b.y && (a.x !== b.x || a.y !== b.y);
  return feasible.filter((p) => !feasible.some((other) => beats(other, p))).sort((a, b) => a.x - b.x);
}

function legend(): HTMLElement {
  const entry = (kind: string, text: string): HTMLElement => h('span', {}, h('i', { class: `dot ${kind}` }), text);
  return h('p', { class: 'legend' }, entry('best', 'the best'), entry('baseline', 'baseline'), entry('front', 'on the front'), entry('', 'beaten'), entry('off', 'not feasible'));
}
