// What is shown: boxes to tick above the 3D view, its colours, and the keys for it.
import type { RunData } from '../data';
import { h } from '../dom';
import type { Keys } from '../keys';
import { kMaxNames } from './cuboids';
import type { FramePanel } from './frames';
import { kFarOff, type Colouring } from './mesh';
import type { State } from './state';
import type { Layer, View3d } from './view3d';

interface Toggle {
  layer: Layer | 'boxes';
  key: string;
  text: string;
  help: string;
  there: boolean;
}

// Without a 3D view there are the boxes in the picture to show or hide; null where there are none either.
export function toolbar(state: State, view: View3d | null, panel: FramePanel | null, keys: Keys): HTMLElement | null {
  const { data } = state;
  const many = state.items.length > kMaxNames ? `; names of the first ${kMaxNames} of ${state.items.length} objects` : '';
  const toggles: Toggle[] = [
    { layer: 'mesh', key: 'm', text: 'surface', help: 'the mapped surface: show or hide', there: data.mesh !== null },
    { layer: 'truth', key: 't', text: 'true', help: `true objects: show or hide${many}`, there: data.truth.length > 0 },
    { layer: 'mapped', key: 'o', text: 'mapped', help: `mapped objects: show or hide${many}`, there: data.mapped.length > 0 },
    { layer: 'path', key: 'p', text: 'path', help: 'the path, estimated (blue) and true (grey): show or hide', there: data.path !== null },
    { layer: 'grow', key: 'g', text: 'grow', help: 'let the map grow with the slider', there: data.mesh !== null && panel !== null },
    { layer: 'boxes', key: 'b', text: 'boxes', help: 'boxes in the picture: show or hide', there: panel !== null },
    { layer: 'cut', key: 'c', text: 'cut at', help: 'what hangs higher: cut off or shown', there: data.mesh !== null },
  ];
  const bar = h('div', { class: 'toolbar', role: 'toolbar', 'aria-label': 'What is shown' });
  const there = toggles.filter((each) => each.there && (view !== null || each.layer === 'boxes'));
  if (there.length === 0 && !view) return null;
  for (const toggle of there) {
    const shown = toggle.layer === 'boxes' || (view?.shows(toggle.layer) ?? false);
    const box = h('input', { type: 'checkbox', id: `show-${toggle.layer}`, checked: shown });
    const apply = (): void => {
      if (toggle.layer !== 'boxes') view?.show(toggle.layer, box.checked);
      else if (panel) panel.boxesShown = box.checked;
    };
    box.addEventListener('change', apply);
    keys.add([toggle.key], toggle.key, toggle.help, () => {
      box.checked = !box.checked;
      apply();
    });
    bar.append(h('label', { title: `${toggle.help} (key ${toggle.key})`, class: `layer of-${toggle.layer}` }, box, toggle.text));
  }
  if (view) {
    if (data.mesh) bar.append(cutter(view, data.mesh.floor));
    if (data.mesh || data.mapped.length > 0) bar.append(...colouring(data, view, keys));
    viewKeys(state, view, keys);
  }
  return bar;
}

function cutter(view: View3d, floor: number): HTMLElement {
  const { low, high, at } = view.cut;
  const reading = h('output', {}, `${(at - floor).toFixed(1)} m`);
  const range = h('input', { type: 'range', min: low, max: high, step: 0.1, value: at, 'aria-label': 'Height of the cut' });
  range.addEventListener('input', () => {
    view.setCut(Number(range.value));
    reading.textContent = `${(Number(range.value) - floor).toFixed(1)} m`;
  });
  return h('span', { class: 'cutter' }, range, reading);
}

function colouring(data: RunData, view: View3d, keys: Keys): HTMLElement[] {
  const ways: [Colouring, string][] = [['photo', 'as seen'], ['label', 'by object']];
  if (data.score?.objects) ways.push(['error', 'by IoU']);
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
  keys.add(['l'], 'l', 'colours: as seen, by object, by IoU, by distance from the true surface', () => {
    colours.selectedIndex = (colours.selectedIndex + 1) % colours.options.length;
    colour();
  });
  return [h('label', {}, 'colours ', colours), legend];
}

function viewKeys(state: State, view: View3d, keys: Keys): void {
  keys.add(['h'], 'h', 'hide the chosen object; again: all are back', () => {
    if (state.chosen && !state.hidden.has(state.chosen)) state.toggleHidden(state.chosen);
    else state.showAll();
  });
  keys.add(['f'], 'f', 'fly to the chosen object', () => state.chosen && view.focus(state.chosen));
  keys.add(['r'], 'r', 'the whole hall again', () => view.resetView());
  keys.add(['a', 'A'], 'a', 'turn to the left', () => view.turn(-0.15, 0));
  keys.add(['d', 'D'], 'd', 'turn to the right', () => view.turn(0.15, 0));
  keys.add(['w', 'W'], 'w', 'turn up', () => view.turn(0, -0.1));
  keys.add(['s', 'S'], 's', 'turn down', () => view.turn(0, 0.1));
  keys.add(['+', '='], '+', 'nearer', () => view.zoom(0.85));
  keys.add(['-'], '−', 'farther', () => view.zoom(1 / 0.85));
}
