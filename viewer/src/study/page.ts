// A study's page: which candidate is best and by how much, what is traded for what, what each factor does, what each candidate sees.
import { pictureUrl, type Candidate, type Measure, type StudyData } from '../data';
import { h, section } from '../dom';
import { fixed, short, signed } from '../format';
import type { Keys } from '../keys';
import { Table, type Column } from '../table';
import { effects } from './effects';
import { Pareto } from './pareto';

export class Choice {
  candidate: Candidate | null = null;
  private readonly listeners: (() => void)[] = [];
  when(listener: () => void): void {
    this.listeners.push(listener);
  }
  choose(candidate: Candidate | null): void {
    this.candidate = candidate;
    for (const listener of this.listeners) listener();
  }
}

export function meanOf(candidate: Candidate | null | undefined, measure: string): number | null {
  return candidate?.measures?.[measure]?.mean ?? null;
}

export function unitOf(measure: Measure): string {
  return measure.unit ? ` (${measure.unit})` : '';
}

export function studyPage(data: StudyData, keys: Keys): HTMLElement[] {
  const study = data.study;
  const byNumber = (number: number | null | undefined): Candidate | null => study.candidates.find((c) => c.number === number) ?? null;
  const best = byNumber(study.best), baseline = byNumber(study.baseline);
  const choice = new Choice();
  const ranked = table(data, best, baseline, choice);
  const pareto = new Pareto(data, choice);
  keys.add(['n', 'ArrowDown'], 'n', 'the next candidate that was run', () => step(study.candidates, choice, 1));
  keys.add(['p', 'ArrowUp'], 'p', 'the one before', () => step(study.candidates, choice, -1));
  keys.add(['b'], 'b', 'the best candidate', () => choice.choose(best));
  Object.assign(window, { waretwinPage: { choice } });
  const parts = [
    cards(data, best, baseline),
    h('div', { class: 'parts study' }, ranked, pareto.element, chosen(data, choice, baseline), effects(data), about(data)),
  ];
  choice.choose(best ?? study.candidates.find((c) => c.state === 'run') ?? null);
  return parts;
}

function step(candidates: Candidate[], choice: Choice, by: number): void {
  const run = candidates.filter((c) => c.state === 'run');
  const index = choice.candidate ? run.indexOf(choice.candidate) : -1;
  choice.choose(run[(index + by + run.length) % run.length] ?? null);
}

function settings(data: StudyData, candidate: Candidate): string {
  return data.study.factors.map((factor) => `${factor.name} ${String(candidate.values[factor.name] ?? '–')}`).join(', ');
}

function cards(data: StudyData, best: Candidate | null, baseline: Candidate | null): HTMLElement {
  const { study } = data;
  const list: HTMLElement[] = [];
  const card = (value: string, text: string, note = ''): HTMLElement => h('div', { class: 'card' }, h('b', {}, value), h('span', {}, text), note ? h('small', {}, note) : null);
  if (best) {
    list.push(card(best.name, 'is the best', settings(data, best)));
    for (const measure of study.measures.slice(0, 5)) {
      const value = best.measures?.[measure.name];
      const difference = best === baseline ? null : value?.difference;
      const against = best === baseline ? 'is the baseline' : difference ? `${signed(difference.mean)} against the baseline${interval(difference)}` : '';
      list.push(card(short(value?.mean), measure.name.replaceAll('_', ' ') + unitOf(measure), against));
    }
  }
  const run = study.candidates.filter((c) => c.state === 'run').length;
  list.push(card(`${run} of ${study.candidates.length}`, 'candidates run', `${(study.halls ?? []).length} halls, ${(study.seeds ?? []).length} seeds`));
  return h('div', { class: 'cards roomy' }, ...list);
}

function interval(of: { low: number | null; high: number | null } | null | undefined): string {
  return of && of.low !== null && of.high !== null ? ` [${short(of.low)}, ${short(of.high)}]` : '';
}

const kStates: Record<Candidate['state'], string> = { run: 'run', screened_out: 'screened out', refused: 'refused' };

function table(data: StudyData, best: Candidate | null, baseline: Candidate | null, choice: Choice): HTMLElement {
  const { study } = data;
  const columns: Column<Candidate>[] = [
    { head: 'candidate', cell: (c) => nameCell(c, best, baseline), value: (c) => c.number, words: true },
    ...study.factors.map((factor): Column<Candidate> => ({ head: factor.name, title: factor.key, cell: (c) => String(c.values[factor.name] ?? '–'), value: (c) => c.values[factor.name] })),
    ...study.measures.map((measure): Column<Candidate> => ({
      head: measure.name.replaceAll('_', ' ') + unitOf(measure),
      title: measure.text,
      better: measure.better ?? 'more',
      cell: (c) => measureCell(c, measure),
      value: (c) => meanOf(c, measure.name),
    })),
  ];
  const ranked = new Table(study.candidates, columns, {
    name: 'Candidates',
    onChoose: (candidate) => choice.choose(candidate),
    rowClass: (c) => [c === best ? 'best' : '', c.state === 'run' ? '' : 'faint'].join(' '),
  });
  const by = study.measures.findIndex((measure) => measure.name === study.best_by);
  if (by >= 0) ranked.sortBy(1 + study.factors.length + by);
  choice.when(() => ranked.choose(choice.candidate, true));
  return section(
    'Candidates',
    ranked.element,
    h('p', { class: 'note' }, `The mean over halls and seeds, with its 95 % interval. ${study.best_by ? `The best has the best ${study.best_by.replaceAll('_', ' ')} of those that hold every constraint. ` : ''}◆ is on the Pareto front. A click on a head sorts.`),
  );
}

function nameCell(candidate: Candidate, best: Candidate | null, baseline: Candidate | null): Node {
  const marks: HTMLElement[] = [];
  const mark = (text: string, kind: string, title = ''): void => void marks.push(h('span', { class: `mark ${kind}`, title }, text));
  if (candidate === best) mark('best', 'best');
  if (candidate === baseline) mark('baseline', '');
  if (candidate.pareto) mark('◆', 'front', 'on the Pareto front');
  if (candidate.state !== 'run') mark(kStates[candidate.state], 'off', candidate.why ?? '');
  else if (candidate.feasible === false) mark('not feasible', 'off', candidate.why ?? '');
  return h('span', {}, candidate.name, ' ', ...marks, candidate.why ? h('small', {}, candidate.why) : null);
}

function measureCell(candidate: Candidate, measure: Measure): Node | string {
  const value = candidate.measures?.[measure.name];
  if (!value) return '–';
  return h('span', {}, short(value.mean), value.low !== null && value.high !== null ? h('small', {}, `${short(value.low)} … ${short(value.high)}`) : null);
}

// All of one candidate, with the baseline beside it.
function chosen(data: StudyData, choice: Choice, baseline: Candidate | null): HTMLElement {
  const body = h('div');
  const part = section('The chosen candidate', body);
  choice.when(() => {
    const candidate = choice.candidate;
    if (!candidate) {
      body.replaceChildren(h('p', { class: 'note' }, 'None is chosen.'));
      return;
    }
    const other = baseline && baseline !== candidate ? baseline : null;
    const rows = data.study.measures.map((measure) => {
      const value = candidate.measures?.[measure.name], against = value?.difference;
      // Coloured only where the interval leaves no doubt about the sign.
      const clear = against?.mean && (against.low === null || against.high === null || against.low > 0 || against.high < 0);
      const better = clear && against?.mean ? (against.mean > 0) === ((measure.better ?? 'more') === 'more') : null;
      return h(
        'tr',
        {},
        h('td', { class: 'words', title: measure.text }, measure.name.replaceAll('_', ' ') + unitOf(measure)),
        h('td', {}, short(value?.mean)),
        h('td', {}, other ? short(meanOf(other, measure.name)) : '–'),
        h('td', { class: better === null ? '' : better ? 'good' : 'bad' }, other && against ? signed(against.mean) + interval(against) : '–'),
      );
    });
    const heads = ['measure', candidate.name, other ? `${other.name} (baseline)` : 'baseline', 'difference [95 %]'];
    body.replaceChildren(
      h('p', {}, h('b', {}, candidate.name), ` ${settings(data, candidate)}`, candidate.why ? ` — ${candidate.why}` : ''),
      candidate.state === 'run' ? h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, ...heads.map((head, i) => h('th', { class: i === 0 ? 'words' : null }, head)))), h('tbody', {}, ...rows))) : '',
      pictures(candidate, other),
      runs(data, candidate) ?? '',
    );
  });
  return part;
}

function pictures(candidate: Candidate, other: Candidate | null): HTMLElement {
  const shot = (of: Candidate, block: string | null, caption: string): HTMLElement | null => {
    const url = pictureUrl(block);
    return url ? h('figure', {}, h('img', { src: url, alt: caption }), h('figcaption', {}, `${of.name}: ${caption}`)) : null;
  };
  const list: (HTMLElement | null)[] = [];
  if (candidate.preview || other?.preview) {
    list.push(shot(candidate, candidate.preview, 'preview'));
    if (other) list.push(shot(other, other.preview, 'preview'));
  }
  const halls = Math.max(candidate.coverage.length, other?.coverage.length ?? 0);
  for (let i = 0; i < halls; ++i) {
    const mine = candidate.coverage[i], theirs = other?.coverage[i];
    if (mine) list.push(shot(candidate, mine.block, `coverage, ${mine.caption}`));
    if (theirs && other) list.push(shot(other, theirs.block, `coverage, ${theirs.caption}`));
  }
  return h('div', { class: other ? 'pictures pair' : 'pictures' }, ...list);
}

function runs(data: StudyData, candidate: Candidate): HTMLElement | null {
  if (!candidate.runs || candidate.runs.length === 0) return null;
  const measures = data.study.measures;
  const rows = candidate.runs.map((run) => h('tr', {}, h('td', { class: 'words' }, run.hall), h('td', {}, String(run.seed)), ...measures.map((measure) => h('td', {}, short(run.measures[measure.name])))));
  return h(
    'details',
    {},
    h('summary', {}, `Its ${candidate.runs.length} runs`),
    h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, h('th', { class: 'words' }, 'hall'), h('th', {}, 'seed'), ...measures.map((measure) => h('th', {}, measure.name.replaceAll('_', ' '))))), h('tbody', {}, ...rows))),
  );
}

function about(data: StudyData): HTMLElement {
  const { study } = data;
  return section(
    'About this study',
    h(
      'ul',
      {},
      ...data.facts.map((fact) => h('li', {}, fact)),
      h('li', {}, `Halls: ${(study.halls ?? []).join(', ') || '–'}; seeds: ${(study.seeds ?? []).map((seed) => fixed(seed, 0)).join(', ') || '–'}`),
      ...study.measures.map((measure) => h('li', {}, h('b', {}, measure.name.replaceAll('_', ' ')), measure.text ? `: ${measure.text}` : '', ` (${measure.better ?? 'more'} is better)`)),
    ),
    h('p', { class: 'files' }, 'Files: ', ...data.files.flatMap((file, i) => [i > 0 ? ', ' : '', h('a', { href: file }, file)])),
  );
}
