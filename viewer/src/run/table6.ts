// Table 6 as mapped and aligned, the paper's own, and what is wrong with each bad object.
import type { RunData, ScoredObject, Summary } from '../data';
import { h, section } from '../dom';
import { colourOfShare, css, fixed } from '../format';
import { Table, type Column } from '../table';
import type { Item, State } from './state';

function iouBar(iou: number | null | undefined): Node {
  if (iou === null || iou === undefined) return h('span', {}, '–');
  const bar = h('span', { class: 'meter' }, fixed(iou, 4));
  bar.style.setProperty('--share', `${Math.round(100 * iou)}%`);
  bar.style.setProperty('--bar', css(colourOfShare(iou)));
  return bar;
}

// A true object, or a mapped one that this table pairs with none.
interface ScoreRow {
  item: Item | null;
  class: string;
  mapId: number | null;
  scored: ScoredObject | null;
}

function rowsOf(state: State, objects: ScoredObject[]): ScoreRow[] {
  const ofTruth = new Map(state.items.filter((item) => item.score).map((item) => [item.score?.truth_id, item]));
  const rows = objects.map((scored): ScoreRow => ({ item: ofTruth.get(scored.truth_id) ?? null, class: scored.class, mapId: scored.map_id, scored }));
  // Its own pairing, not the page's: aligned, other objects may belong together.
  const paired = new Set(objects.map((object) => object.map_id));
  const strays = state.data.mapped.filter((box) => !paired.has(box.id));
  return [...rows, ...strays.map((box): ScoreRow => ({ item: state.itemOfMapId(box.id), class: box.class, mapId: box.id, scored: null }))];
}

function scoreTable(state: State, objects: ScoredObject[], summary: Partial<Summary>, name: string): { element: HTMLElement; choose: (item: Item | null) => void } {
  const rows = rowsOf(state, objects);
  const columns: Column<ScoreRow>[] = [
    { head: 'object', cell: (r) => (r.scored ? `${r.scored.truth_id}${r.scored.counted ? '' : ' (not counted)'}` : '–'), value: (r) => r.scored?.truth_id },
    { head: 'class', cell: (r) => r.class, value: (r) => r.class, words: true },
    { head: 'map id', cell: (r) => String(r.mapId ?? '–'), value: (r) => r.mapId },
    { head: 'IoU 3D', cell: (r) => iouBar(r.scored?.iou3d), value: (r) => r.scored?.iou3d, better: 'more' },
    { head: 'E trans (m)', cell: (r) => fixed(r.scored?.e_trans_m, 3), value: (r) => r.scored?.e_trans_m, better: 'less' },
    { head: 'E rot (°)', cell: (r) => fixed(r.scored?.e_rot_deg, 1), value: (r) => r.scored?.e_rot_deg, better: 'less' },
    { head: 'seen', title: 'Share of the viewable surface that the mapped frames saw', cell: (r) => fixed(r.scored?.visible_fraction, 2), value: (r) => r.scored?.visible_fraction, better: 'more' },
  ];
  const paper = state.data.paper.table6;
  const mean = paper.at(-1);
  const footer: string[][] = [['average', '', '', fixed(summary.mean_iou3d, 4), fixed(summary.mean_e_trans_m, 3), fixed(summary.mean_e_rot_deg, 1), '']];
  if (mean) footer.push(['the paper', '', '', fixed(mean.iou3d, 4), fixed(mean.e_trans_m, 3), fixed(mean.e_rot_deg, 1), '']);
  const table = new Table(rows, columns, {
    name,
    footer,
    onChoose: (row: ScoreRow) => state.choose(row.item),
    rowClass: (row: ScoreRow) => (row.scored && !row.scored.counted ? 'faint' : ''),
  });
  return {
    element: h(
      'div',
      {},
      table.element,
      h('p', { class: 'note' }, `${summary.matched ?? '–'} of ${summary.truth ?? '–'} objects matched (IoU ≥ 0.5), ${summary.mapped ?? '–'} mapped; mAP as in the paper ${fixed(summary.map_paper, 2)}, AP50 ${fixed(summary.ap50, 2)}.`),
    ),
    choose: (item) => {
      const row = rows.find((each) => item !== null && each.scored !== null && each.item === item) ?? rows.find((each) => item?.mapped && each.mapId === item.mapped.id);
      table.choose(row ?? null);
    },
  };
}

export function table6(state: State): HTMLElement | null {
  const score = state.data.score;
  if (!score?.objects) return null;
  const tables = [scoreTable(state, score.objects, score.summary ?? {}, 'Table 6, as mapped')];
  const tabs = h('div', { class: 'tabs', role: 'tablist' });
  const body = h('div');
  const names = ['as mapped'];
  if (score.objects_aligned) {
    tables.push(scoreTable(state, score.objects_aligned, score.summary_aligned ?? {}, 'Table 6, aligned'));
    names.push('aligned to the truth');
  }
  const show = (index: number): void => {
    body.replaceChildren(tables[index]?.element ?? '');
    if (index === 1 && score.alignment) {
      body.append(
        h('p', { class: 'note' }, `The map was moved by ${fixed(score.alignment.x_m, 3)} m, ${fixed(score.alignment.y_m, 3)} m and ${fixed(score.alignment.yaw_deg, 2)}°. The paper's truth was annotated in its own map, so its table holds no drift.`),
      );
    }
    [...tabs.children].forEach((tab, i) => tab.setAttribute('aria-selected', String(i === index)));
  };
  names.forEach((name, index) => tabs.append(h('button', { role: 'tab', onclick: () => show(index) }, name)));
  show(0);
  state.whenChosen(() => tables.forEach((table) => table.choose(state.chosen)));
  return section('Table 6', names.length > 1 ? tabs : null, body, paperTable(state.data));
}

export function explanations(data: RunData): HTMLElement | null {
  const lines = data.score?.explanations ?? [];
  if (lines.length === 0) return null;
  const who = (line: (typeof lines)[number]): string => (line.truth_id !== null ? `Object ${line.truth_id}` : `Mapped object ${line.map_id ?? '?'}`);
  return section('What is wrong', h('ul', {}, ...lines.map((line) => h('li', {}, h('b', {}, who(line)), `: ${line.text}.`))));
}

function paperTable(data: RunData): HTMLElement {
  const cells = (values: string[]): HTMLElement => h('tr', {}, ...values.map((value) => h('td', {}, value)));
  return h(
    'details',
    {},
    h('summary', {}, "The paper's own Table 6"),
    h(
      'table',
      {},
      h('thead', {}, h('tr', {}, ...['object', 'IoU 3D', 'E trans (m)', 'E rot (°)'].map((head) => h('th', {}, head)))),
      h('tbody', {}, ...data.paper.table6.map((row) => cells([row.id, fixed(row.iou3d, 4), fixed(row.e_trans_m, 3), fixed(row.e_rot_deg, 1)]))),
    ),
  );
}
