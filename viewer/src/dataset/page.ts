// A set of training pictures: a sheet to look through, what is in it by numbers, one picture large.
import { pictureUrl, type DatasetData, type DatasetImage } from '../data';
import { bars } from '../chart';
import { h, s, section } from '../dom';
import { colourOfId, css } from '../format';
import type { Keys } from '../keys';

export function datasetPage(data: DatasetData, keys: Keys): HTMLElement[] {
  const sheet = new Sheet(data, keys);
  return [cards(data), h('div', { class: 'parts wide' }, sheet.element, statistics(data), about(data))];
}

function cards(data: DatasetData): HTMLElement {
  const { dataset } = data;
  const card = (value: string, text: string, note = ''): HTMLElement => h('div', { class: 'card' }, h('b', {}, value), h('span', {}, text), note ? h('small', {}, note) : null);
  const labels = dataset.classes.reduce((sum, each) => sum + each.labels, 0);
  const counts = (of: Record<string, number>): string => Object.entries(of).map(([name, count]) => `${name} ${count}`).join(', ');
  return h(
    'div',
    { class: 'cards' },
    card(String(dataset.images), 'pictures', counts(dataset.splits)),
    card(String(labels), 'labels', `of ${dataset.classes.length} ${dataset.classes.length === 1 ? 'class' : 'classes'}`),
    card(String(dataset.without_labels), 'without labels', 'on purpose, or all too small'),
    card(String(dataset.halls), 'halls', counts(dataset.views)),
    card(String((dataset.left_out['hidden'] ?? 0) + (dataset.left_out['small'] ?? 0)), 'left out', counts(dataset.left_out)),
  );
}

function boxesOf(data: DatasetData, image: DatasetImage, wanted: number | null, amodal: boolean): SVGSVGElement {
  const [width, height] = image.size;
  const unit = width / (amodal ? 900 : 400);
  const svg = s('svg', { class: 'boxes', viewBox: `0 0 ${width} ${height}`, preserveAspectRatio: 'none' });
  for (const label of image.labels) {
    if (wanted !== null && label.class !== wanted) continue;
    const colour = css(colourOfId(label.class + 1));
    const [x, y, w, tall] = label.box;
    if (amodal) {
      const [ax, ay, aw, at] = label.amodal_box;
      svg.append(s('rect', { x: ax, y: ay, width: aw, height: at, fill: 'none', stroke: colour, 'stroke-width': unit, 'stroke-dasharray': `${4 * unit}` }));
    }
    svg.append(
      s('rect', { x, y, width: w, height: tall, fill: 'none', stroke: colour, 'stroke-width': 2.2 * unit }, s('title', {}, `${data.dataset.classes[label.class]?.name ?? '?'}, ${Math.round(100 * label.visible)} % visible`)),
    );
    if (amodal) {
      svg.append(
        s('text', { x: x + 3 * unit, y: Math.max(y, 0) + 14 * unit, 'font-size': 13 * unit, fill: '#fff', stroke: '#000', 'stroke-width': 2 * unit, 'paint-order': 'stroke' }, `${data.dataset.classes[label.class]?.name ?? '?'} ${Math.round(100 * label.visible)} %`),
      );
    }
  }
  if (amodal) {
    for (const left of image.left_out) {
      const [x, y, w, tall] = left.box;
      svg.append(s('rect', { x, y, width: w, height: tall, fill: 'none', stroke: '#bbb', 'stroke-width': unit, 'stroke-dasharray': `${2 * unit}` }, s('title', {}, `left out: ${left.why}`)));
    }
  }
  return svg;
}

class Sheet {
  readonly element: HTMLElement;
  private readonly grid = h('div', { class: 'sheet' });
  private readonly large = h('dialog', { class: 'large', 'aria-label': 'One picture', autofocus: true, tabindex: -1 });
  private readonly count = h('span', { class: 'note' });
  private readonly classes: HTMLSelectElement;
  private readonly splits: HTMLSelectElement;
  private readonly boxes = h('input', { type: 'checkbox', id: 'show-boxes', checked: true });
  private shown: DatasetImage[] = [];
  private current = -1;

  constructor(private readonly data: DatasetData, keys: Keys) {
    const options = (all: string, list: [string, string][]): HTMLOptionElement[] => [h('option', { value: '' }, all), ...list.map(([value, text]) => h('option', { value }, text))];
    this.classes = h('select', { id: 'class-filter', 'aria-label': 'Class' }, ...options('all classes', data.dataset.classes.map((c, i) => [String(i), c.name])), h('option', { value: 'none' }, 'without labels'));
    this.splits = h('select', { 'aria-label': 'Split' }, ...options('all splits', Object.keys(data.dataset.splits).map((name) => [name, name])));
    for (const control of [this.classes, this.splits]) control.addEventListener('change', () => this.fill());
    this.boxes.addEventListener('change', () => this.showBoxes());
    keys.add(['ArrowRight'], '→', 'the next picture', () => this.go(this.current + 1));
    keys.add(['ArrowLeft'], '←', 'the picture before', () => this.go(this.current - 1));
    // Elsewhere these two scroll.
    const inSheet = (target: EventTarget | null): boolean => target instanceof Node && (this.grid.contains(target) || this.large.contains(target));
    keys.add(['ArrowDown'], '↓', 'a row down (a picture in focus)', () => this.go(this.current + this.across()), inSheet);
    keys.add(['ArrowUp'], '↑', 'a row up (a picture in focus)', () => this.go(this.current - this.across()), inSheet);
    keys.add(['b'], 'b', 'boxes: show or hide', () => {
      this.boxes.checked = !this.boxes.checked;
      this.showBoxes();
    });
    document.body.append(this.large);
    this.large.addEventListener('click', (event) => event.target instanceof HTMLAnchorElement || this.large.close());
    this.element = section('Pictures', h('p', { class: 'axes' }, this.classes, this.splits, h('label', {}, this.boxes, 'boxes'), this.count), this.grid);
    this.fill();
  }

  private fill(): void {
    const wanted = this.classes.value;
    this.shown = this.data.images.filter((image) => {
      if (this.splits.value && image.split !== this.splits.value) return false;
      if (wanted === 'none') return image.labels.length === 0;
      return !wanted || image.labels.some((label) => label.class === Number(wanted));
    });
    const only = wanted && wanted !== 'none' ? Number(wanted) : null;
    this.grid.replaceChildren(
      ...this.shown.map((image, index) =>
        h(
          'button',
          { class: 'thumb', title: `${image.name}: ${image.hall}, ${image.kind}, ${image.split}`, onclick: () => this.open(index), onfocus: () => (this.current = index) },
          h('img', { src: pictureUrl(image.block), alt: `picture ${image.name}`, loading: 'lazy' }),
          boxesOf(this.data, image, only, false),
        ),
      ),
    );
    this.current = -1;
    this.count.textContent = `${this.shown.length} of ${this.data.images.length} shown pictures; the set has ${this.data.dataset.images}`;
  }

  // They are there all the time: nothing loses its focus, and the picture that is open stays.
  private showBoxes(): void {
    for (const part of [this.grid, this.large]) part.classList.toggle('boxless', !this.boxes.checked);
  }

  private across(): number {
    const tops = [...this.grid.children].map((child) => (child as HTMLElement).offsetTop);
    const row = tops.findIndex((top) => top !== tops[0]);
    return row > 0 ? row : Math.max(1, tops.length);
  }

  private go(index: number): void {
    if (this.shown.length === 0) return;
    const next = Math.min(this.shown.length - 1, Math.max(0, index));
    this.current = next;
    (this.grid.children[next] as HTMLElement | undefined)?.focus();
    if (this.large.open) this.open(next);
  }

  private open(index: number): void {
    const image = this.shown[index];
    if (!image) return;
    this.current = index;
    this.large.replaceChildren(
      h('figure', { class: 'shot' }, h('img', { src: pictureUrl(image.block), alt: `picture ${image.name}` }), boxesOf(this.data, image, null, true)),
      h('p', {}, h('b', {}, image.name), ` ${image.hall}, ${image.kind} view, ${image.split}; ${image.labels.length} ${image.labels.length === 1 ? 'label' : 'labels'}, ${image.left_out.length} left out. Dashed: the whole object, hidden and cut-off parts included; grey: left out. Arrows go on, Esc closes. `, h('a', { href: `images/${image.name}.jpg` }, 'The picture itself')),
    );
    if (!this.large.open) this.large.showModal();
  }
}

function statistics(data: DatasetData): HTMLElement {
  const { classes } = data.dataset;
  const charts = h('div', { class: 'effects' });
  const select = h('select', { 'aria-label': 'Class' }, h('option', { value: '' }, 'all classes'), ...classes.map((c, i) => h('option', { value: i }, c.name)));
  const draw = (): void => {
    const chosen = select.value === '' ? classes : classes.filter((_, i) => String(i) === select.value);
    const sum = (lists: number[][]): number[] => (lists[0] ?? []).map((_, i) => lists.reduce((total, list) => total + (list[i] ?? 0), 0));
    const sides = sum(chosen.map((c) => c.sides)), visible = sum(chosen.map((c) => c.visible));
    charts.replaceChildren(
      bars(sides, sides.map((_, i) => `${Math.round((100 * i) / sides.length)}`), 'labels', "box size: side of its area, in % of the picture's"),
      bars(visible, visible.map((_, i) => `${Math.round((100 * i) / visible.length)}`), 'labels', 'visible part of the object (%)'),
      ...(classes.length > 1 && select.value === '' ? [bars(classes.map((c) => c.labels), classes.map((c) => c.name), 'labels', 'class')] : []),
    );
  };
  select.addEventListener('change', draw);
  draw();
  return section('What is in the set', h('p', { class: 'axes' }, select), charts);
}

function about(data: DatasetData): HTMLElement {
  return section(
    'About this set',
    h('ul', {}, ...data.facts.map((fact) => h('li', {}, fact))),
    h('p', { class: 'files' }, 'Files: ', ...data.files.flatMap((file, i) => [i > 0 ? ', ' : '', h('a', { href: file }, file)])),
  );
}
