// Two measures against each other, a point a candidate that has both.
import type { Candidate, Measure, StudyData } from '../data';
import { Frame, niceScale, pathOf } from '../chart';
import { h, s, section } from '../dom';
import { short } from '../format';
import { anyDriven, meanOf, measuresWithValues, settingsText, wordsOf, type Choice } from './candidates';

interface Point {
  candidate: Candidate;
  x: number;
  y: number;
}

export class Pareto {
  readonly element: HTMLElement;
  private readonly measures: Measure[];
  private readonly plot = h('div', { class: 'chartbox' });
  private readonly x: HTMLSelectElement;
  private readonly y: HTMLSelectElement;
  private readonly words = h('p', { class: 'note', 'aria-live': 'polite' });
  private dots: { point: Point; dot: SVGCircleElement }[] = [];
  private frame: Frame | null = null;
  // The name beside the chosen point; the best and the baseline have their own.
  private readonly name = s('text', { class: 'name' });

  constructor(private readonly data: StudyData, private readonly choice: Choice) {
    this.measures = measuresWithValues(data.study);
    const own = data.study.pareto?.measures ?? [];
    const axis = (label: string, wanted: string | undefined): HTMLSelectElement => {
      const select = h('select', { 'aria-label': label }, ...this.measures.map((m) => h('option', { value: m.name, selected: m.name === wanted }, wordsOf(m.name))));
      select.addEventListener('change', () => this.draw());
      return select;
    };
    this.x = axis('Across', own[1] ?? this.measures[1]?.name);
    this.y = axis('Up', own[0] ?? this.measures[0]?.name);
    this.element = section('What is traded for what', h('p', { class: 'axes' }, h('label', {}, 'up ', this.y), h('label', {}, 'across ', this.x)), this.plot, this.words);
    choice.when(() => this.mark());
    this.draw();
  }

  private draw(): void {
    const { study } = this.data;
    const measure = (select: HTMLSelectElement): Measure | undefined => this.measures.find((m) => m.name === select.value);
    const mx = measure(this.x), my = measure(this.y);
    this.dots = [];
    this.frame = null;
    const points = study.candidates.flatMap((candidate): Point[] => {
      const x = mx ? meanOf(candidate, mx.name) : null, y = my ? meanOf(candidate, my.name) : null;
      return x !== null && y !== null ? [{ candidate, x, y }] : [];
    });
    if (!mx || !my || points.length === 0) {
      this.plot.replaceChildren(h('p', { class: 'note' }, 'No candidate has both measures.'));
      return;
    }
    const span = (values: number[]): [number, number] => [Math.min(...values), Math.max(...values)];
    const name = (m: Measure): string => `${wordsOf(m.name)}${m.better ? `, ${m.better} is better` : ''}`;
    const frame = new Frame(niceScale(...span(points.map((p) => p.x))), niceScale(...span(points.map((p) => p.y))), name(mx), name(my), 320);
    // An image has no parts; these points can be reached.
    frame.svg.setAttribute('role', 'group');
    const driven = anyDriven(study);
    const front = this.frontOf(points, mx, my);
    frame.plot.append(s('path', { class: 'front', d: pathOf(front.map((p) => [frame.px(p.x), frame.py(p.y)])) }));
    for (const point of points) {
      const { candidate } = point;
      const best = candidate.number === study.best, baseline = candidate.number === study.baseline;
      const kind = ['point', front.includes(point) ? 'front' : '', candidate.feasible === false ? 'off' : '', driven && candidate.state === 'screened_out' ? 'quiet' : '', best ? 'best' : '', baseline ? 'baseline' : ''].join(' ');
      const dot = s('circle', { class: kind, cx: frame.px(point.x), cy: frame.py(point.y), tabindex: 0, role: 'button', 'aria-label': candidate.name, 'data-candidate': candidate.name }, s('title', {}, `${candidate.name}: ${short(point.x)}, ${short(point.y)}`));
      const say = (): void => void (this.words.textContent = `${candidate.name}: ${wordsOf(my.name)} ${short(point.y)}, ${wordsOf(mx.name)} ${short(point.x)}; ${settingsText(study, candidate)}`);
      dot.addEventListener('pointerenter', say);
      dot.addEventListener('focus', say);
      dot.addEventListener('click', () => this.choice.choose(candidate));
      dot.addEventListener('keydown', (event) => {
        if (event.key !== 'Enter' && event.key !== ' ') return;
        event.preventDefault(); // space would scroll
        event.stopPropagation();
        this.choice.choose(candidate);
      });
      this.dots.push({ point, dot });
      frame.plot.append(dot);
      if (best || baseline) frame.plot.append(s('text', { class: 'name', x: frame.px(point.x) + 10, y: frame.py(point.y) - 8 }, candidate.name));
    }
    frame.plot.append(this.name);
    this.frame = frame;
    this.plot.replaceChildren(frame.svg, legend(points.some((p) => driven && p.candidate.state === 'screened_out')));
    this.mark();
  }

  // The points stay, so that the one in focus keeps it.
  private mark(): void {
    this.name.textContent = '';
    for (const { point, dot } of this.dots) {
      const { number, name } = point.candidate;
      const chosen = point.candidate === this.choice.candidate;
      dot.classList.toggle('chosen', chosen);
      dot.setAttribute('aria-pressed', String(chosen));
      dot.setAttribute('r', chosen ? '8' : '6');
      if (!chosen || !this.frame || number === this.data.study.best || number === this.data.study.baseline) continue;
      this.name.textContent = name;
      this.name.setAttribute('x', String(this.frame.px(point.x) + 10));
      this.name.setAttribute('y', String(this.frame.py(point.y) - 8));
    }
  }

  // Along the front. Of the study's own two measures it is what the study says: there, who has no value in some drive cannot be on it.
  private frontOf(points: Point[], mx: Measure, my: Measure): Point[] {
    const { study } = this.data;
    const along = (front: Point[]): Point[] => front.sort((a, b) => a.x - b.x);
    const own = study.pareto?.measures ?? [];
    if (own.length === 2 && own.includes(mx.name) && own.includes(my.name) && mx !== my) return along(points.filter((p) => p.candidate.pareto));
    if (!mx.better || !my.better) return [];
    const driven = anyDriven(study);
    return along(unbeaten(points.filter((p) => p.candidate.feasible !== false && (!driven || p.candidate.state === 'run')), mx, my));
  }
}

// Those that no other beats in both.
function unbeaten(points: Point[], mx: Measure, my: Measure): Point[] {
  const sx = mx.better === 'less' ? -1 : 1, sy = my.better === 'less' ? -1 : 1;
  const beats = (a: Point, b: Point): boolean => sx * a.x >= sx * b.x && sy * a.y >= sy * b.y && (a.x !== b.x || a.y !== b.y);
  return points.filter((p) => !points.some((other) => beats(other, p)));
}

function legend(quiet: boolean): HTMLElement {
  const entry = (kind: string, text: string): HTMLElement => h('span', {}, h('i', { class: `dot ${kind}` }), text);
  return h('p', { class: 'legend' }, entry('best', 'the best'), entry('baseline', 'baseline'), entry('front', 'on the front'), entry('', 'beaten'), entry('off', 'not feasible'), quiet ? entry('quiet', 'screened out') : null);
}
