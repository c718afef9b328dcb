// Tables whose rows can be chosen and, where asked for, sorted by a click on a head.
import { h } from './dom';

export interface Column<Row> {
  head: string;
  title?: string;
  cell: (row: Row) => Node | string;
  // What it is sorted by; rows without a value come last. Columns without are not sorted.
  value?: (row: Row) => number | string | null | undefined;
  better?: 'more' | 'less';
  words?: boolean; // left-aligned
}

export interface TableOptions<Row> {
  onChoose?: (row: Row) => void;
  rowClass?: (row: Row) => string;
  footer?: (string | Node)[][];
  name?: string;
}

export class Table<Row> {
  readonly element: HTMLElement;
  private readonly body = h('tbody');
  private readonly heads: HTMLElement[] = [];
  private readonly elements = new Map<Row, HTMLTableRowElement>();
  private sortedBy: { column: number; down: boolean } | null = null;

  constructor(
    private readonly rows: Row[],
    private readonly columns: Column<Row>[],
    private readonly options: TableOptions<Row> = {},
  ) {
    const head = h('tr');
    columns.forEach((column, index) => {
      const cell = h('th', { scope: 'col', title: column.title, class: column.words ? 'words' : null });
      if (column.value) {
        cell.append(h('button', { class: 'sort', onclick: () => this.sortBy(index) }, column.head));
      } else {
        cell.append(column.head);
      }
      this.heads.push(cell);
      head.append(cell);
    });
    const foot = h('tfoot', {}, ...(options.footer ?? []).map((cells) => h('tr', {}, ...cells.map((cell) => h('td', {}, cell)))));
    this.element = h('div', { class: 'scroll' }, h('table', { 'aria-label': options.name }, h('thead', {}, head), this.body, foot));
    for (const row of rows) this.elements.set(row, this.make(row));
    this.show(rows);
  }

  // The same column again turns the order round; the first click puts what is better first.
  sortBy(index: number): void {
    const column = this.columns[index];
    if (!column?.value) return;
    const down = this.sortedBy?.column === index ? !this.sortedBy.down : column.better === 'more';
    this.sortedBy = { column: index, down };
    const value = column.value;
    const sorted = [...this.rows].sort((a, b) => {
      const x = value(a), y = value(b);
      const none = (v: unknown): boolean => v === null || v === undefined || (typeof v === 'number' && !Number.isFinite(v));
      if (none(x) || none(y)) return Number(none(x)) - Number(none(y));
      const order = typeof x === 'number' && typeof y === 'number' ? x - y : String(x).localeCompare(String(y), 'en', { numeric: true });
      return down ? -order : order;
    });
    this.heads.forEach((head, i) => head.setAttribute('aria-sort', i === index ? (down ? 'descending' : 'ascending') : 'none'));
    this.show(sorted);
  }

  choose(row: Row | null, scroll = false): void {
    for (const [each, element] of this.elements) {
      element.classList.toggle('chosen', each === row);
      element.setAttribute('aria-selected', String(each === row));
      if (each === row && scroll) element.scrollIntoView({ block: 'nearest' });
    }
  }

  private make(row: Row): HTMLTableRowElement {
    const element = h('tr', { class: this.options.rowClass?.(row) ?? '' }, ...this.columns.map((c) => h('td', { class: c.words ? 'words' : null }, c.cell(row))));
    const choose = this.options.onChoose;
    if (choose) {
      element.tabIndex = 0;
      element.addEventListener('click', () => choose(row));
      element.addEventListener('keydown', (event) => {
        if (event.key !== 'Enter' && event.key !== ' ') return;
        event.preventDefault();
        event.stopPropagation();
        choose(row);
      });
    }
    return element;
  }

  private show(rows: Row[]): void {
    const elements: HTMLElement[] = [];
    for (const row of rows) {
      const element = this.elements.get(row);
      if (element) elements.push(element);
    }
    this.body.replaceChildren(...elements);
  }
}
