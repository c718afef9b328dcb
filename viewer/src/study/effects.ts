// What each level of each factor does to a measure, all else being equal: a mean and its interval a level.
import type { StudyData } from '../data';
import { Frame, kBottom, kTop, niceScale, pathOf } from '../chart';
import { h, s, section } from '../dom';
import { short } from '../format';
import { confidenceText, wordsOf } from './candidates';

export function effects(data: StudyData): HTMLElement | null {
  const all = data.study.effects ?? [];
  if (all.length === 0) return null;
  const confidence = confidenceText(data.study);
  const measures = [...new Set(all.map((effect) => effect.measure))];
  const body = h('div', { class: 'effects' });
  const select = h('select', { 'aria-label': 'Measure' }, ...measures.map((m) => h('option', { value: m, selected: m === data.study.best_by }, wordsOf(m))));
  const draw = (): void => {
    const shown = all.filter((effect) => effect.measure === select.value);
    // One scale for all factors, so that they can be compared.
    const values = shown.flatMap((effect) => effect.levels.flatMap((level) => [level.mean, level.low, level.high])).filter((v): v is number => v !== null && v !== undefined);
    if (values.length === 0) {
      body.replaceChildren(h('p', { class: 'note' }, 'Nothing was measured.'));
      return;
    }
    const scale = niceScale(Math.min(...values), Math.max(...values), 5);
    body.replaceChildren(
      ...shown.map((effect) => {
        const frame = new Frame({ low: 0, high: effect.levels.length, ticks: [] }, scale, wordsOf(effect.factor), wordsOf(effect.measure), 220, false);
        const line: [number, number][] = [];
        effect.levels.forEach((level, i) => {
          const x = frame.px(i + 0.5);
          frame.svg.append(s('text', { class: 'tick', x, y: frame.height - kBottom + 14, 'text-anchor': 'middle' }, String(level.level)));
          if (level.mean === null) return;
          line.push([x, frame.py(level.mean)]);
          if (typeof level.low === 'number' && typeof level.high === 'number') frame.plot.append(s('line', { class: 'interval', x1: x, x2: x, y1: Math.max(kTop, frame.py(level.high)), y2: frame.py(level.low) }));
          frame.plot.append(s('circle', { class: 'level', cx: x, cy: frame.py(level.mean), r: 4.5 }, s('title', {}, `${String(level.level)}: ${short(level.mean)}${level.candidates ? `, ${level.candidates} ${level.candidates === 1 ? 'candidate' : 'candidates'}` : ''}`)));
        });
        frame.plot.prepend(s('path', { class: 'line', d: pathOf(line) }));
        return h('div', { class: 'chartbox' }, frame.svg);
      }),
    );
  };
  select.addEventListener('change', draw);
  draw();
  return section('What each factor does', h('p', { class: 'axes' }, h('label', {}, 'measure ', select)), body, h('p', { class: 'note' }, `What the candidates of a level have on average, all other factors being equal (least squares over candidates). ${confidence ? `Bars are ${confidence} intervals; the` : 'The'} scale is the same for all factors.`));
}
