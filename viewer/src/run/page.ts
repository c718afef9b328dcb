// A run's page: 3D view and frames above, with one slider for both; tables and charts below.
import { pictureUrl, type RunData } from '../data';
import { h, section } from '../dom';
import type { Keys } from '../keys';
import { FramePanel } from './frames';
import { kFarOff, type Colouring } from './mesh';
import { cards, chartsOverTime, details, detections, mappedTable, table6, texts, timing } from './score';
import { State } from './state';
import { View3d, type Layer } from './view3d';

interface Toggle {
  layer: Layer | 'boxes';
  key: string;
  text: string;
  help: string;
  there: boolean;
}

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

  const left = h('div', { class: 'left' });
  if (view) {
    left.append(view.element, details(state), toolbar(data, state, view, panel, keys));
  } else {
    left.append(stillPicture(data), details(state));
    console.info(`no 3D: ${why}`);
  }
  const stage = h('div', { class: panel ? 'stage' : 'stage alone' }, left, panel?.element);
  if (panel) stage.append(slider(state, keys));
  keys.add(['Escape'], 'Esc', 'choose nothing', () => state.choose(null));

  const parts = [...table6(state), data.score ? null : mappedTable(state), ...chartsOverTime(state), timing(state), ...texts(data), detections(data), about(data)];
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

function toolbar(data: RunData, state: State, view: View3d, panel: FramePanel | null, keys: Keys): HTMLElement {
  const toggles: Toggle[] = [
    { layer: 'mesh', key: 'm', text: 'surface', help: 'the mapped surface: show or hide', there: data.mesh !== null },
    { layer: 'truth', key: 't', text: 'true', help: 'true objects: show or hide', there: data.truth.length > 0 },
    { layer: 'mapped', key: 'o', text: 'mapped', help: 'mapped objects: show or hide', there: data.mapped.length > 0 },
    { layer: 'path', key: 'p', text: 'path', help: 'the path, estimated (blue) and true (grey): show or hide', there: data.path !== null },
    { layer: 'grow', key: 'g', text: 'grow', help: 'let the map grow with the slider', there: data.mesh !== null && panel !== null },
    { layer: 'boxes', key: 'b', text: 'boxes', help: 'boxes in the picture: show or hide', there: panel !== null },
    { layer: 'cut', key: 'c', text: 'cut at', help: 'what hangs higher: cut off or shown', there: data.mesh !== null },
  ];
  const bar = h('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'What is shown' });
  for (const toggle of toggles.filter((each) => each.there)) {
    const shown = toggle.layer === 'boxes' ? true : view.shows(toggle.layer);
    const box = h('input', { type: 'checkbox', id: `show-${toggle.layer}`, checked: shown });
    const apply = (): void => {
      if (toggle.layer !== 'boxes') view.show(toggle.layer, box.checked);
      else if (panel) panel.boxesShown = box.checked;
    };
    box.addEventListener('change', apply);
    keys.add([toggle.key], toggle.key, toggle.help, () => {
      box.checked = !box.checked;
      apply();
    });
    bar.append(h('label', { title: `${toggle.help} (key ${toggle.key})`, class: `layer of-${toggle.layer}` }, box, toggle.text));
  }
  if (data.mesh) {
    const { low, high, at } = view.cut;
    const reading = h('output', {}, `${(at - data.mesh.floor).toFixed(1)} m`);
    const floor = data.mesh.floor;
    const range = h('input', { type: 'range', min: low, max: high, step: 0.1, value: at, 'aria-label': 'Height of the cut' });
    range.addEventListener('input', () => {
      view.setCut(Number(range.value));
      reading.textContent = `${(Number(range.value) - floor).toFixed(1)} m`;
    });
    bar.append(h('span', { class: 'cutter' }, range, reading));
  }
  const ways: [Colouring, string][] = [['photo', 'as seen'], ['label', 'by object']];
  if (data.score) ways.push(['error', 'by IoU']);
  if (data.mesh && data.mesh.error_step !== null) ways.push(['surface', 'by distance']);
  const colours = h('select', { id: 'colouring', 'aria-label': 'Colours' }, ...ways.map(([value, text]) => h('option', { value }, text)));
  const legend = h('span', { class: 'ramp', hidden: true });
  const colour = (): void => {
    view.colour(colours.value as Colouring);
    legend.hidden = colours.value !== 'error' && colours.value !== 'surface';
    if (colours.value === 'error') legend.replaceChildren('IoU 0', h('i'), '1');
    else legend.replaceChildren('0', h('i', { class: 'off' }), `${1000 * kFarOff} mm`);
  };
  colours.addEventListener('change', colour);
  if (data.mesh || data.mapped.length > 0) bar.append(h('label', {}, 'colours ', colours), legend);
  if (data.mesh || data.mapped.length > 0) keys.add(['l'], 'l', 'colours: as seen, by object, by IoU, by distance from the true surface', () => {
    colours.selectedIndex = (colours.selectedIndex + 1) % colours.options.length;
    colour();
  });
  keys.add(['h'], 'h', 'hide the chosen object; again: all are back', () => {
    if (state.chosen && !state.hidden.has(state.chosen)) state.toggleHidden(state.chosen);
    else state.showAll();
  });
  keys.add(['f'], 'f', 'fly to the chosen object', () => state.chosen && view.focus(state.chosen));
  keys.add(['r'], 'r', 'the whole hall again', () => view.resetView());
  keys.add(['n'], 'n', 'the next object', () => {
    const index = state.chosen ? state.items.indexOf(state.chosen) : -1;
    state.choose(state.items[(index + 1) % state.items.length] ?? null);
  });
  keys.add(['a', 'A'], 'a', 'turn to the left', () => view.turn(-0.15, 0));
  keys.add(['d', 'D'], 'd', 'turn to the right', () => view.turn(0.15, 0));
  keys.add(['w', 'W'], 'w', 'turn up', () => view.turn(0, -0.1));
  keys.add(['s', 'S'], 's', 'turn down', () => view.turn(0, 0.1));
  keys.add(['+', '='], '+', 'nearer', () => view.zoom(0.85));
  keys.add(['-'], '−', 'farther', () => view.zoom(1 / 0.85));
  return bar;
}

function slider(state: State, keys: Keys): HTMLElement {
  const last = state.data.frames.length - 1;
  const range = h('input', { type: 'range', class: 'time', min: 0, max: last, step: 1, value: state.frame, 'aria-label': 'Time of the drive' });
  const reading = h('output');
  const update = (): void => {
    range.value = String(state.frame);
    reading.textContent = `${state.time.toFixed(1)} s`;
    range.setAttribute('aria-valuetext', `${state.time.toFixed(1)} seconds`);
  };
  range.addEventListener('input', () => state.setFrame(Number(range.value)));
  state.whenFrame(update);
  update();
  let timer = 0;
  const play = h('button', { class: 'play', 'aria-label': 'Play', title: 'space' }, '▶');
  const stop = (): void => {
    window.clearInterval(timer);
    timer = 0;
    play.textContent = '▶';
  };
  const toggle = (): void => {
    if (timer) {
      stop();
      return;
    }
    if (state.frame === last) state.setFrame(0);
    play.textContent = '❚❚';
    timer = window.setInterval(() => (state.frame === last ? stop() : state.setFrame(state.frame + 1)), 125);
  };
  play.addEventListener('click', toggle);
  const step = (by: number) => (): void => {
    if (timer) stop();
    state.setFrame(state.frame + by);
  };
  keys.add(['ArrowLeft', 'ArrowDown'], '←', 'a frame back', step(-1));
  keys.add(['ArrowRight', 'ArrowUp'], '→', 'a frame on', step(1));
  keys.add(['PageUp'], 'Page up', 'ten frames back', step(-10));
  keys.add(['PageDown'], 'Page down', 'ten frames on', step(10));
  keys.add(['Home'], 'Home', 'to the start', step(-last));
  keys.add(['End'], 'End', 'to the end', step(last));
  keys.add([' '], 'Space', 'play and stop', toggle);
  return h('div', { class: 'slider' }, play, range, reading);
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
