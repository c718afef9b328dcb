// The little Markdown that waretwin writes itself: headings, paragraphs, lists, tables and **bold**.
import { h } from './dom';

export function markdown(text: string): HTMLElement {
  const root = h('div', { class: 'markdown' });
  const lines = text.split('\n');
  const cells = (line: string): string[] => line.trim().replace(/^\||\|$/g, '').split('|').map((cell) => cell.trim());
  for (let i = 0; i < lines.length; ) {
    const line = lines[i] ?? '';
    if (line.startsWith('|')) {
      const head = cells(line);
      const body: HTMLElement[] = [];
      for (i += 2; i < lines.length && (lines[i] ?? '').startsWith('|'); ++i) {
        body.push(h('tr', {}, ...cells(lines[i] ?? '').map((cell) => h('td', {}, ...inline(cell)))));
      }
      root.append(h('div', { class: 'scroll' }, h('table', {}, h('thead', {}, h('tr', {}, ...head.map((cell) => h('th', {}, ...inline(cell))))), h('tbody', {}, ...body))));
    } else if (line.startsWith('- ')) {
      const list = h('ul');
      for (; i < lines.length && (lines[i] ?? '').startsWith('- '); ++i) list.append(h('li', {}, ...inline((lines[i] ?? '').slice(2))));
      root.append(list);
    } else if (line.startsWith('#')) {
      // The page has a heading of its own.
      if (!line.startsWith('# ')) root.append(h('h3', {}, ...inline(line.replace(/^#+ */, ''))));
      ++i;
    } else if (line.trim()) {
      const words: string[] = [];
      for (; i < lines.length && (lines[i] ?? '').trim() && !/^[|#-]/.test(lines[i] ?? ''); ++i) words.push(lines[i] ?? '');
      if (words.length === 0) words.push(lines[i++] ?? '');
      root.append(h('p', {}, ...inline(words.join(' '))));
    } else {
      ++i;
    }
  }
  return root;
}

// Every second part is between the stars.
function inline(text: string): (Node | string)[] {
  return text.split(/\*\*(.+?)\*\*/).map((part, i) => (i % 2 === 1 ? h('b', {}, part) : part));
}
