// All of one candidate, with the baseline beside it.
import { pictureUrl, type Candidate, type StudyData } from '../data';
import { h, section } from '../dom';
import { short, signed } from '../format';
import { brokenText, confidenceText, isMeasured, meanOf, measuresWithValues, settingsText, wordsOf, type Choice } from './candidates';

export function interval(of: { low?: number | null; high?: number | null } | null | undefined): string {
  return typeof of?.low === 'number' && typeof of.high === 'number' ? ` [${short(of.low)}, ${short(of.high)}]` : '';
}

export function chosen(data: StudyData, choice: Choice, baseline: Candidate | null): HTMLElement {
  const body = h('div');
  choice.when(() => {
    const candidate = choice.candidate;
    if (!candidate) {
      body.replaceChildren(h('p', { class: 'note' }, 'None is chosen.'));
      return;
    }
    const other = baseline && baseline !== candidate ? baseline : null;
    const broken = brokenText(candidate);
    body.replaceChildren(
      h('p', {}, h('b', {}, candidate.name), ` ${settingsText(data.study, candidate)}`, broken ? ` — ${broken}` : ''),
      isMeasured(candidate) ? values(data, candidate, other) : '',
      pictures(candidate, other),
      drives(data, candidate) ?? '',
    );
  });
  return section('The chosen candidate', body);
}

function values(data: StudyData, candidate: Candidate, other: Candidate | null): HTMLElement {
  const rows = measuresWithValues(data.study).map((measure) => {
    const value = candidate.measures?.[measure.name], against = value?.difference;
    // Coloured only where the interval leaves no doubt about the sign.
    const clear = measure.better && against?.mean && (against.low === null || against.high === null || against.low > 0 || against.high < 0);
    const better = clear && against?.mean ? (against.mean > 0) === (measure.better === 'more') : null;
    return h(
      'tr',
      {},
      h('td', { class: 'words', title: measure.text }, wordsOf(measure.name)),
      h('td', {}, short(value?.mean)),
      h('td', {}, other ? short(meanOf(other, measure.name)) : '–'),
      h('td', { class: better === null ? '' : better ? 'good' : 'bad' }, other && against ? signed(against.mean) + interval(against) : '–'),
    );
  });
  const confidence = confidenceText(data.study);
  const heads = ['measure', candidate.name, other ? `${other.name} (baseline)` : 'baseline', `difference${confidence ? ` [${confidence}]` : ''}`];
  return h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, ...heads.map((head, i) => h('th', { class: i === 0 ? 'words' : null }, head)))), h('tbody', {}, ...rows)));
}

function pictures(candidate: Candidate, other: Candidate | null): HTMLElement {
  const shot = (of: Candidate, block: string | null | undefined, caption: string): HTMLElement | null => {
    const url = pictureUrl(block ?? null);
    return url ? h('figure', {}, h('img', { src: url, alt: caption }), h('figcaption', {}, `${of.name}: ${caption}`)) : null;
  };
  const list = [shot(candidate, candidate.preview, 'preview'), other ? shot(other, other.preview, 'preview') : null];
  const mine = candidate.coverage ?? [], theirs = other?.coverage ?? [];
  for (let i = 0; i < Math.max(mine.length, theirs.length); ++i) {
    const own = mine[i], beside = theirs[i];
    if (own) list.push(shot(candidate, own.block, `coverage, ${own.caption}`));
    if (beside && other) list.push(shot(other, beside.block, `coverage, ${beside.caption}`));
  }
  return h('div', { class: other ? 'pictures pair' : 'pictures' }, ...list);
}

function drives(data: StudyData, candidate: Candidate): HTMLElement | null {
  const runs = candidate.runs ?? [];
  if (runs.length === 0) return null;
  // Coverage is a hall's, not a drive's.
  const measures = data.study.measures.filter((measure) => measure.source !== 'coverage');
  const rows = runs.map((run) => {
    const cells = run.error ? [h('td', { class: 'words bad', colspan: Math.max(1, measures.length) }, run.error)] : measures.map((measure) => h('td', {}, short(run.measures?.[measure.name])));
    return h('tr', {}, h('td', { class: 'words' }, run.hall), h('td', {}, String(run.seed)), ...cells);
  });
  const failed = runs.filter((run) => run.error).length;
  return h(
    'details',
    { open: failed > 0 },
    h('summary', {}, `Its ${runs.length} ${runs.length === 1 ? 'drive' : 'drives'}${failed > 0 ? `, ${failed} failed` : ''}`),
    h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, h('th', { class: 'words' }, 'hall'), h('th', {}, 'seed'), ...measures.map((measure) => h('th', {}, wordsOf(measure.name))))), h('tbody', {}, ...rows))),
  );
}
