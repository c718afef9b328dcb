// What the camera saw at the slider's moment: the picture with its boxes, and the depth.
import { pictureUrl, type Frame } from '../data';
import { h, s } from '../dom';
import { colourOfId, css, fixed } from '../format';
import type { State } from './state';

export class FramePanel {
  readonly element: HTMLElement;
  private readonly picture = h('img', { class: 'colour', alt: '' });
  private readonly depth = h('img', { class: 'depth', alt: '' });
  private readonly boxes = s('svg', { class: 'boxes', preserveAspectRatio: 'xMidYMid meet' });
  private readonly words = h('p', { class: 'words', 'aria-live': 'polite' });
  private readonly depthFigure: HTMLElement;
  private readonly colourFigure: HTMLElement;
  private showBoxes = true;

  constructor(private readonly state: State) {
    this.colourFigure = h('figure', { class: 'shot' }, this.picture, this.boxes);
    this.depthFigure = h('figure', { class: 'shot' }, this.depth, h('figcaption', {}, 'depth: red is near, blue far, black nothing'));
    this.element = h('aside', { class: 'frames', 'aria-label': 'What the camera saw' }, this.colourFigure, this.depthFigure, this.words);
    state.whenFrame(() => this.update());
    state.whenChosen(() => this.drawBoxes());
    this.update();
  }

  get boxesShown(): boolean {
    return this.showBoxes;
  }
  set boxesShown(on: boolean) {
    this.showBoxes = on;
    this.boxes.style.display = on ? '' : 'none';
  }

  private get frame(): Frame | undefined {
    return this.state.data.frames[this.state.frame];
  }

  private update(): void {
    const frame = this.frame;
    if (!frame) return;
    const colour = pictureUrl(frame.colour), depth = pictureUrl(frame.depth);
    // A drive without colour has its boxes over the depth.
    const first = colour ?? depth;
    this.colourFigure.hidden = first === null;
    if (first) this.picture.src = first;
    this.picture.alt = `frame ${frame.frame}, ${colour ? 'colour' : 'depth'}`;
    this.depthFigure.hidden = colour === null || depth === null;
    if (depth) this.depth.src = depth;
    this.depth.alt = `frame ${frame.frame}, depth`;
    const known = frame.objects.length;
    this.words.textContent =
      `Frame ${frame.frame} of ${frame.sensor} at ${frame.t_s.toFixed(1)} s: ${frame.detections.length} ` +
      `${frame.detections.length === 1 ? 'detection' : 'detections'}, ${known} ${known === 1 ? 'object' : 'objects'} in the map`;
    this.drawBoxes();
  }

  private drawBoxes(): void {
    const frame = this.frame;
    if (!frame) return;
    const [width, height] = frame.size;
    this.boxes.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const unit = width / 480;
    const parts = frame.detections.map((detection) => {
      const [x, y, w, tall] = detection.box;
      const colour = detection.map_id > 0 ? css(colourOfId(detection.map_id)) : '#fff';
      const chosen = detection.map_id > 0 && this.state.chosen?.mapped?.id === detection.map_id;
      const text = `${detection.class} ${fixed(detection.score, 2)}${detection.map_id > 0 ? ` → ${detection.map_id}` : ''}`;
      const box = s('rect', { x, y, width: w, height: tall, fill: chosen ? colour : 'none', 'fill-opacity': 0.2, stroke: colour, 'stroke-width': (chosen ? 3.5 : 2) * unit, 'stroke-dasharray': detection.map_id > 0 ? null : `${5 * unit}` });
      const label = s('text', { x: x + 4 * unit, y: Math.max(y, 0) + 13 * unit, 'font-size': 12 * unit, fill: '#fff', stroke: '#000', 'stroke-width': 2.6 * unit, 'paint-order': 'stroke' }, text);
      const group = s('g', {}, box, label);
      const item = this.state.itemOfMapId(detection.map_id);
      if (item) {
        group.style.cursor = 'pointer';
        group.style.pointerEvents = 'all';
        group.addEventListener('click', () => this.state.choose(item));
      }
      return group;
    });
    this.boxes.replaceChildren(...parts);
  }
}
