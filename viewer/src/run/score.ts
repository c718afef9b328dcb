// What a run's numbers say: key figures, timing, errors over time, detections.
import type { RunData } from '../data';
import { h, section } from '../dom';
import { stackedChart, timeChart, type TimeChart } from '../chart';
import { fixed } from '../format';
import { markdown } from '../markdown';
import { Table } from '../table';
import { nameOf, type Item, type State } from './state';

function card(value: string, text: string, note = ''): HTMLElement {
  return h('div', { class: 'card' }, h('b', {}, value), h('span', {}, text), note ? h('small', {}, note) : null);
}

export function cards(data: RunData): HTMLElement {
  const list: HTMLElement[] = [];
  const score = data.score;
  if (score) {
    const summary = score.summary, paper = data.paper.table6.at(-1);
    if (summary) {
      list.push(
        card(`${summary.matched ?? '–'} of ${summary.truth ?? '–'}`, 'objects found', `${summary.mapped ?? '–'} mapped`),
        card(fixed(summary.mean_iou3d, 3), 'mean 3D IoU', paper ? `the paper: ${fixed(paper.iou3d, 3)}` : ''),
        card(`${fixed(typeof summary.mean_e_trans_m === 'number' ? 100 * summary.mean_e_trans_m : null, 1)} cm`, 'translation error', paper ? `the paper: ${fixed(100 * paper.e_trans_m, 1)} cm` : ''),
        card(`${fixed(summary.mean_e_rot_deg, 2)}°`, 'rotation error', paper ? `the paper: ${fixed(paper.e_rot_deg, 1)}°` : ''),
      );
    }
    if (score.trajectory) list.push(card(`${fixed(100 * score.trajectory.ate_rmse_m, 1)} cm`, 'path error, rmse', `${fixed(100 * score.trajectory.ate_max_m, 1)} cm at most`));
    if (score.surface) list.push(card(`${fixed(1000 * score.surface.median_m, 1)} mm`, 'surface error', `median; ${fixed(100 * score.surface.found, 1)} % there`));
  } else if (data.kind === 'map') {
    list.push(card(String(data.mapped.length), data.mapped.length === 1 ? 'object mapped' : 'objects mapped'));
  }
  const frame = data.timing?.stages.find((stage) => stage.stage === 'frame');
  if (frame) list.push(card(`${fixed(frame.median, 0)} ms`, 'a mapped frame', `median; 95 %: ${fixed(frame.p95, 0)} ms`));
  if (data.path && data.path.length > 1) {
    let length = 0;
    data.path.forEach((row, i) => {
      const before = data.path?.[i - 1];
      if (before) length += Math.hypot(row[1] - before[1], row[2] - before[2], row[3] - before[3]);
    });
    list.push(card(`${fixed(length, 1)} m`, 'path length', `in ${fixed(data.path.at(-1)?.[0], 0)} s`));
  }
  return h('div', { class: 'cards' }, ...list);
}

export function mappedTable(state: State): HTMLElement | null {
  const items = state.items.filter((item) => item.mapped);
  if (items.length === 0) return null;
  const table = new Table<Item>(
    items,
    [
      { head: 'map id', cell: (i) => String(i.mapped?.id), value: (i) => i.mapped?.id },
      { head: 'class', cell: (i) => i.class, value: (i) => i.class, words: true },
      { head: 'centre (m)', cell: (i) => (i.mapped?.centre ?? []).map((v) => fixed(v, 2)).join(', ') },
      { head: 'size (m)', cell: (i) => (i.mapped?.size ?? []).map((v) => fixed(v, 2)).join(' × ') },
      { head: 'yaw (°)', cell: (i) => fixed(((i.mapped?.yaw ?? 0) * 180) / Math.PI, 1) },
      { head: 'score', cell: (i) => fixed(i.mapped?.score, 2), value: (i) => i.mapped?.score, better: 'more' },
    ],
    { onChoose: (item) => state.choose(item), name: 'Mapped objects' },
  );
  state.whenChosen(() => table.choose(state.chosen));
  return section('Mapped objects', table.element);
}

const kStageNames: Record<string, string> = { simulate: 'Simulation or reading', localise: 'Localisation' };

// The paper's Table 4 with ours beside it.
export function timing(state: State): HTMLElement | null {
  const { timing: times, paper } = state.data;
  if (!times) return null;
  const rows = times.stages
    .filter((stage) => stage.stage !== 'simulate')
    .map((stage) => {
      const theirs = paper.table4.find((row) => row.stage === stage.stage);
      return h(
        'tr',
        { class: stage.stage === 'frame' ? 'sum' : '' },
        ...[theirs?.name ?? kStageNames[stage.stage] ?? stage.stage].map((text) => h('td', { class: 'words' }, text)),
        ...[fixed(stage.mean, 1), fixed(stage.median, 1), fixed(stage.p95, 1), fixed(stage.max, 1), theirs ? fixed(theirs.cpu, 1) : '–', theirs ? fixed(theirs.gpu, 0) : '–'].map((text) => h('td', {}, text)),
      );
    });
  const heads = ['module', 'mean', 'median', '95 %', 'largest', "paper's CPU", "paper's GPU"];
  const source = times.stages.find((stage) => stage.stage === 'simulate');
  return section(
    'Time per mapped frame, as in Table 4 (ms)',
    h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, ...heads.map((head, i) => h('th', { class: i === 0 ? 'words' : null }, head)))), h('tbody', {}, ...rows))),
    h('p', { class: 'note' }, "The paper's figures are means over ten SceneNN sequences on its own computer.", source ? ` Simulating or reading a frame's pictures took ${fixed(source.median, 0)} ms more (median).` : ''),
  );
}

export function chartsOverTime(state: State): HTMLElement[] {
  const charts: TimeChart[] = [];
  const parts: HTMLElement[] = [];
  const go = (t: number): void => state.setTime(t);
  const error = state.data.path_error;
  if (error && error.length > 1) {
    const metres = timeChart(error.map((row) => [row[0], 100 * row[1]]), 'position (cm)', go);
    const degrees = timeChart(error.map((row) => [row[0], row[2]]), 'rotation (°)', go);
    charts.push(metres, degrees);
    parts.push(section('Trajectory error over time', metres.element, degrees.element, h('p', { class: 'note' }, 'Not aligned: where the robot thought it was against where it was. A click goes to that moment.')));
  }
  const rows = state.data.timing?.frames ?? [];
  if (rows.length > 2) {
    const chart = stackedChart(rows, ['localise', 'detect', 'segment', 'associate', 'integrate'], 'ms', go);
    charts.push(chart);
    parts.push(section('Time per mapped frame over the drive', chart.element));
  }
  const mark = (): void => charts.forEach((chart) => chart.setTime(state.time));
  state.whenFrame(mark);
  mark();
  return parts;
}

export function detections(data: RunData): HTMLElement | null {
  const found = data.score?.detection;
  if (!found) return null;
  const line = (name: string, row: { labels: number; precision: number | null; recall: number | null; ap50: number | null; ap: number | null; tp: number; fp: number; fn: number }, sum = false): HTMLElement =>
    h('tr', { class: sum ? 'sum' : '' }, h('td', { class: 'words' }, name), ...[String(row.labels), fixed(row.precision, 3), fixed(row.recall, 3), fixed(row.ap50, 3), fixed(row.ap, 3), String(row.tp), String(row.fp), String(row.fn)].map((text) => h('td', {}, text)));
  const heads = ['class', 'labels', 'precision', 'recall', 'AP50', 'AP', 'found', 'wrong', 'missed'];
  const confusions = (found.confusions ?? []).map((c) => h('li', {}, `${c.truth ?? 'background'} ${c.detected === null ? 'missed' : `taken for ${c.detected}`}, ${c.count} times`));
  return section(
    'Detections in the mapped frames',
    h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, ...heads.map((head, i) => h('th', { class: i === 0 ? 'words' : null }, head)))), h('tbody', {}, ...(found.classes ?? []).map((row) => line(row.class ?? '?', row)), line('all', found, true)))),
    confusions.length > 0 ? h('ul', {}, ...confusions) : null,
  );
}

export function texts(data: RunData): HTMLElement[] {
  const parts: HTMLElement[] = [];
  if (data.budget) parts.push(section('Error budget', markdown(data.budget)));
  if (data.verdict) parts.push(section('Against the baseline', markdown(data.verdict)));
  return parts;
}

// The chosen object, beside the 3D view.
export function details(state: State): HTMLElement {
  const box = h('div', { class: 'details', 'aria-live': 'polite', hidden: true });
  state.whenChosen(() => {
    const item = state.chosen;
    box.hidden = item === null;
    if (!item) return;
    const size = (values: number[] | undefined): string => (values ? values.map((v) => v.toFixed(2)).join(' × ') + ' m' : '–');
    const rows: [string, string][] = [];
    if (item.score) {
      rows.push(['3D IoU', fixed(item.score.iou3d, 4)], ['off by', `${fixed(item.score.e_trans_m, 3)} m, ${fixed(item.score.e_rot_deg, 1)}°`], ['seen', `${fixed(100 * item.score.visible_fraction, 0)} % of its surface`]);
    }
    if (item.mapped) rows.push(['mapped size', size(item.mapped.size)]);
    if (item.truth) rows.push(['true size', size(item.truth.size)]);
    const since = state.data.frames.find((frame) => frame.objects.some((object) => object.id === item.mapped?.id));
    if (since) rows.push(['in the map since', `${since.t_s.toFixed(1)} s`]);
    const why = state.data.score?.explanations?.find((line) => (item.score ? line.truth_id === item.score.truth_id : line.map_id === item.mapped?.id));
    box.replaceChildren(
      h('b', {}, nameOf(item)),
      h('dl', {}, ...rows.flatMap(([key, value]) => [h('dt', {}, key), h('dd', {}, value)])),
      why ? h('p', {}, why.text + '.') : '',
    );
  });
  return box;
}
