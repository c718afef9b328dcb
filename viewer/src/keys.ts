// The page's keys, and the overlay that lists them.
import { h } from './dom';

export interface Key {
  keys: string[]; // KeyboardEvent.key
  shown: string;
  text: string;
  run: () => void;
}

export class Keys {
  private readonly list: Key[] = [];
  private readonly overlay = h('dialog', { class: 'help', 'aria-label': 'Keys' });

  constructor() {
    this.add(['?'], '?', 'this list', () => this.toggleHelp());
    document.addEventListener('keydown', (event) => this.onKey(event));
    this.overlay.addEventListener('click', () => this.overlay.close());
    document.body.append(this.overlay);
  }

  add(keys: string[], shown: string, text: string, run: () => void): void {
    this.list.push({ keys, shown, text, run });
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
    // A button or a row has its own Enter and space.
    const takesPress = target instanceof HTMLButtonElement || target instanceof HTMLInputElement || (target instanceof HTMLElement && target.tabIndex === 0 && !(target instanceof HTMLCanvasElement));
    if (event.key === ' ' && takesPress) return;
    // Sliders other than the time's have their own arrows.
    if (target instanceof HTMLInputElement && target.type === 'range' && !target.classList.contains('time') && event.key.startsWith('Arrow')) return;
    const found = this.list.find((key) => key.keys.includes(event.key));
    if (!found) return;
    event.preventDefault();
    found.run();
  }
}
