// A run's page: 3D view and frames above, with one slider for both; tables and charts below.
import { pictureUrl, type RunData } from '../data';
import { h, section } from '../dom';
import type { Keys } from '../keys';
import { FramePanel } from './frames';
import { cards, chartsOverTime, details, detections, mappedTable, texts, timing } from './score';
import { slider } from './slider';
import { State } from './state';
import { explanations, table6 } from './table6';
import { toolbar } from './toolbar';
import { View3d } from './view3d';

export function runPage(data: RunData, keys: Keys): HTMLElement[] {
  const state = new State(data);
  const panel = data.frames.length > 0 ? new FramePanel(state) : null;
  let view: View3d | null = null;
  let why = '';
  try {
    view = new View3d(state);
  } catch (problem) {
    why = problem instanceof Error ? problem.message : String(problem);
  }

  const left = h('div', { class: 'left' }, view ? view.element : stillPicture(data), details(state), toolbar(state, view, panel, keys));
  if (!view) console.info(`no 3D: ${why}`);
  const stage = h('div', { class: panel ? 'stage' : 'stage alone' }, left, panel?.element);
  if (panel) stage.append(slider(state, keys));
  keys.add(['n'], 'n', 'the next object', () => {
    const index = state.chosen ? state.items.indexOf(state.chosen) : -1;
    state.choose(state.items[(index + 1) % state.items.length] ?? null);
  });
  keys.add(['Escape'], 'Esc', 'choose nothing', () => state.choose(null));

  const parts = [table6(state), explanations(data), data.score?.objects ? null : mappedTable(state), ...chartsOverTime(state), timing(state), ...texts(data), detections(data), about(data)];
  const shown = parts.filter((part): part is HTMLElement => part !== null);
  // For the browser tests.
  Object.assign(window, { waretwinPage: { state, view } });
  return [cards(data), stage, h('div', { class: 'parts' }, ...shown)];
}

function stillPicture(data: RunData): HTMLElement {
  const first = data.pictures[0];
  const url = first ? pictureUrl(first.block) : null;
  return h(
    'figure',
    { class: 'still' },
    url ? h('img', { src: url, alt: first?.caption }) : null,
    h('figcaption', {}, 'This browser shows no 3D (WebGL), so here is a still picture. ', first?.caption ?? ''),
  );
}

function about(data: RunData): HTMLElement {
  const mesh = data.mesh;
  const note = mesh && mesh.triangles < mesh.of_triangles ? `The surface shown here is thinned to ${mesh.triangles.toLocaleString('en')} of ${mesh.of_triangles.toLocaleString('en')} triangles.` : '';
  const pictures = data.pictures.map((picture) => {
    const url = pictureUrl(picture.block);
    return url ? h('figure', {}, h('img', { src: url, alt: picture.caption, loading: 'lazy' }), h('figcaption', {}, picture.caption)) : null;
  });
  return section(
    'About this run',
    h('ul', {}, ...data.facts.map((fact) => h('li', {}, fact)), note ? h('li', {}, note) : null),
    h('details', {}, h('summary', {}, 'Pictures of the map'), ...pictures),
    h('p', { class: 'files' }, 'Files: ', ...data.files.flatMap((file, i) => [i > 0 ? ', ' : '', h('a', { href: file }, file)])),
  );
}
