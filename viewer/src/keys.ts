// The page's keys, and the overlay that lists them.
import { h } from './dom';

export interface Key {
  keys: string[]; // KeyboardEvent.key
  shown: string;
  text: string;
  run: () => void;
  // Whether it is meant for what has the focus; elsewhere the browser does with it what it does on any page.
  where: ((target: EventTarget | null) => boolean) | undefined;
}

// What a slider in focus does by itself.
const kRangeKeys = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'PageUp', 'PageDown', 'Home', 'End'];

export class Keys {
  private readonly list: Key[] = [];
  private readonly overlay = h('dialog', { class: 'help', 'aria-label': 'Keys' });

  constructor() {
    this.add(['?'], '?', 'this list', () => this.toggleHelp());
    document.addEventListener('keydown', (event) => this.onKey(event));
    this.overlay.addEventListener('click', () => this.overlay.close());
    document.body.append(this.overlay);
  }

  add(keys: string[], shown: string, text: string, run: () => void, where?: (target: EventTarget | null) => boolean): void {
    this.list.push({ keys, shown, text, run, where });
  }

  toggleHelp(): void {
    if (this.overlay.open) {
      this.overlay.close();
      return;
    }
    const rows = this.list.map((key) => h('li', {}, h('kbd', {}, key.shown), key.text));
    rows.push(h('li', {}, h('kbd', {}, 'Tab'), h('kbd', {}, 'Enter'), 'to a row, a head, a button; choose it'));
    this.overlay.replaceChildren(h('h2', {}, 'Keys'), h('ul', {}, ...rows), h('p', {}, 'Esc or a click closes this.'));
    this.overlay.showModal();
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    if (target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.type === 'text')) return;
    if (this.overlay.open && event.key !== '?') return;
    const found = this.list.find((key) => key.keys.includes(event.key) && (key.where?.(target) ?? true));
    if (!found) return;
    if (!found.where && target instanceof HTMLInputElement && target.type === 'range' && kRangeKeys.includes(event.key)) return;
    event.preventDefault();
    found.run();
  }
}
