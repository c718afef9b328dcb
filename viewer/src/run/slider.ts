// The drive's time: a slider, a button that plays, and their keys.
import { h } from '../dom';
import type { Keys } from '../keys';
import type { State } from './state';

export function slider(state: State, keys: Keys): HTMLElement {
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
  const play = h('button', { class: 'play', 'aria-label': 'Play', title: 'space, with the slider or the 3D view in focus' }, '▶');
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
  keys.add(['ArrowLeft'], '←', 'a frame back', step(-1));
  keys.add(['ArrowRight'], '→', 'a frame on', step(1));
  const here = (key: string, shown: string, text: string, run: () => void): void => keys.add([key], shown, `${text} (slider or 3D view in focus)`, run, isOfDrive);
  here('ArrowDown', '↓', 'a frame back', step(-1));
  here('ArrowUp', '↑', 'a frame on', step(1));
  here('PageUp', 'Page up', 'ten frames back', step(-10));
  here('PageDown', 'Page down', 'ten frames on', step(10));
  here('Home', 'Home', 'to the start', step(-last));
  here('End', 'End', 'to the end', step(last));
  here(' ', 'Space', 'play and stop', toggle);
  return h('div', { class: 'slider' }, play, range, reading);
}

// Elsewhere these keys scroll, as on any page.
function isOfDrive(target: EventTarget | null): boolean {
  return target instanceof HTMLCanvasElement || (target instanceof HTMLInputElement && target.classList.contains('time'));
}
