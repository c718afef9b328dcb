// A study's page: which candidate is best and by how much, what is traded for what, what each factor does, what each candidate sees.
import type { Candidate, Measure, StudyData } from '../data';
import { h, section } from '../dom';
import { fixed, short, signed } from '../format';
import type { Keys } from '../keys';
import { Table, type Column } from '../table';
import { anyDriven, brokenText, Choice, confidenceText, isMeasured, meanOf, measuresWithValues, settingsText, wordsOf } from './candidates';
import { chosen, interval } from './chosen';
import { effects } from './effects';
import { Pareto } from './pareto';

export function studyPage(data: StudyData, keys: Keys): HTMLElement[] {
  const study = data.study;
  const byNumber = (number: number | null | undefined): Candidate | null => study.candidates.find((c) => c.number === number) ?? null;
  const best = byNumber(study.best), baseline = byNumber(study.baseline);
  const choice = new Choice();
  const ranked = table(data, best, baseline, choice);
  const pareto = new Pareto(data, choice);
  keys.add(['n'], 'n', 'the next candidate that was measured', () => step(study.candidates, choice, 1));
  keys.add(['p'], 'p', 'the one before', () => step(study.candidates, choice, -1));
  keys.add(['b'], 'b', 'the best candidate', () => choice.choose(best));
  Object.assign(window, { waretwinPage: { choice } });
  const parts = [
    h('p', { class: 'verdict' }, h('b', {}, 'Best: '), study.verdict ?? best?.name ?? 'none'),
    cards(data, best, baseline),
    h('div', { class: 'parts study' }, ranked, pareto.element, chosen(data, choice, baseline), effects(data), about(data)),
  ];
  choice.choose(best ?? study.candidates.find(isMeasured) ?? study.candidates[0] ?? null);
  return parts;
}

function step(candidates: Candidate[], choice: Choice, by: number): void {
  const measured = candidates.filter(isMeasured);
  const index = choice.candidate ? measured.indexOf(choice.candidate) : -1;
  const next = index < 0 && by < 0 ? measured.length - 1 : (index + by + measured.length) % measured.length;
  choice.choose(measured[next] ?? choice.candidate);
}

function cards(data: StudyData, best: Candidate | null, baseline: Candidate | null): HTMLElement {
  const { study } = data;
  const list: HTMLElement[] = [];
  const card = (value: string, text: string, note = ''): HTMLElement => h('div', { class: 'card' }, h('b', {}, value), h('span', {}, text), note ? h('small', {}, note) : null);
  if (best) {
    list.push(card(best.name, 'is the best', settingsText(study, best)));
    for (const measure of measuresWithValues(study).slice(0, 5)) {
      const value = best.measures?.[measure.name];
      const difference = best === baseline ? null : value?.difference;
      const against = best === baseline ? 'is the baseline' : difference ? `${signed(difference.mean)} against the baseline${interval(difference)}` : '';
      list.push(card(short(value?.mean), wordsOf(measure.name), against));
    }
  }
  const count = (state: Candidate['state']): number => study.candidates.filter((c) => c.state === state).length;
  const halls = (study.halls ?? []).length, seeds = (study.seeds ?? []).length;
  const of = `${halls} ${halls === 1 ? 'hall' : 'halls'}`;
  const refused = count('refused') > 0 ? `${count('refused')} refused; ` : '';
  if (anyDriven(study)) {
    const screened = count('screened_out') > 0 ? `${count('screened_out')} screened out, ` : '';
    list.push(card(`${count('run')} of ${study.candidates.length}`, 'candidates run', `${screened}${refused}${of}, ${seeds} ${seeds === 1 ? 'seed' : 'seeds'}`));
  } else {
    list.push(card(`${study.candidates.filter(isMeasured).length} of ${study.candidates.length}`, 'candidates measured, by coverage alone', refused + of));
  }
  return h('div', { class: 'cards roomy' }, ...list);
}

const kStates: Record<Candidate['state'], string> = { run: 'run', screened_out: 'screened out', refused: 'refused' };

function table(data: StudyData, best: Candidate | null, baseline: Candidate | null, choice: Choice): HTMLElement {
  const { study } = data;
  const measures = measuresWithValues(study), driven = anyDriven(study);
  const columns: Column<Candidate>[] = [
    { head: 'candidate', cell: (c) => nameCell(c, best, baseline, driven), value: (c) => c.number, words: true },
    ...study.factors.map((factor): Column<Candidate> => ({ head: factor.name, title: factor.key, cell: (c) => String(c.values[factor.name] ?? '–'), value: (c) => c.values[factor.name] })),
    ...measures.map((measure): Column<Candidate> => ({
      head: wordsOf(measure.name),
      title: measure.text,
      better: measure.better ?? 'more',
      cell: (c) => measureCell(c, measure),
      value: (c) => meanOf(c, measure.name),
    })),
  ];
  const isQuiet = (c: Candidate): boolean => c.state === 'refused' || (driven && c.state === 'screened_out');
  const ranked = new Table(study.candidates, columns, {
    name: 'Candidates',
    onChoose: (candidate) => choice.choose(candidate),
    rowClass: (c) => [c === best ? 'best' : '', isQuiet(c) ? 'faint' : ''].join(' '),
  });
  const by = measures.findIndex((measure) => measure.name === study.best_by);
  if (by >= 0) ranked.sortBy(1 + study.factors.length + by);
  choice.when(() => ranked.choose(choice.candidate, true));
  const confidence = confidenceText(study);
  const what = driven ? 'The mean over halls and seeds' : 'Nothing was driven: the mean over halls of what the sensors see';
  return section(
    'Candidates',
    ranked.element,
    h('p', { class: 'note' }, `${what}, with its ${confidence ? `${confidence} ` : ''}interval. ${study.best_by ? `The best has the best ${wordsOf(study.best_by)} of those that hold every constraint. ` : ''}◆ is on the Pareto front. A click on a head sorts.`),
  );
}

function nameCell(candidate: Candidate, best: Candidate | null, baseline: Candidate | null, driven: boolean): Node {
  const marks: HTMLElement[] = [];
  const broken = brokenText(candidate);
  const mark = (text: string, kind: string, title = ''): void => void marks.push(h('span', { class: `mark ${kind}`, title }, text));
  if (candidate === best) mark('best', 'best');
  if (candidate === baseline) mark('baseline', '');
  if (candidate.pareto) mark('◆', 'front', 'on the Pareto front');
  // Where nothing was driven, none was screened out for the sake of others.
  if (candidate.state === 'refused' || (driven && candidate.state === 'screened_out')) mark(kStates[candidate.state], 'off', broken);
  else if (candidate.feasible === false) mark('not feasible', 'off', broken);
  return h('span', {}, candidate.name, ' ', ...marks, broken ? h('small', { class: 'broken' }, broken) : null);
}

function measureCell(candidate: Candidate, measure: Measure): Node | string {
  const value = candidate.measures?.[measure.name];
  if (!value) return '–';
  const range = typeof value.low === 'number' && typeof value.high === 'number' ? `${short(value.low)} … ${short(value.high)}` : '';
  return h('span', {}, short(value.mean), range ? h('small', {}, range) : null);
}

function about(data: StudyData): HTMLElement {
  const { study } = data;
  const there = new Set(measuresWithValues(study).map((measure) => measure.name));
  const constraints = study.constraints ?? [];
  return section(
    'About this study',
    h(
      'ul',
      {},
      ...data.facts.map((fact) => h('li', {}, fact)),
      h('li', {}, `Halls: ${(study.halls ?? []).join(', ') || '–'}; seeds: ${(study.seeds ?? []).map((seed) => fixed(seed, 0)).join(', ') || '–'}`),
      constraints.length > 0 ? h('li', {}, `Constraints: ${constraints.join(', ')}`) : null,
      ...study.measures.map((measure) =>
        h('li', {}, h('b', {}, wordsOf(measure.name)), measure.text ? `: ${measure.text}` : '', ` (${measure.better ?? 'more'} is better)`, there.has(measure.name) ? '' : ', which no candidate has a value of'),
      ),
    ),
    h('p', { class: 'files' }, 'Files: ', ...data.files.flatMap((file, i) => [i > 0 ? ', ' : '', h('a', { href: file }, file)])),
  );
}
