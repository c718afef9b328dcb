// Reads the page's data and shows the page of its kind.
import './style.css';
import { readData, type PageData } from './data';
import { datasetPage } from './dataset/page';
import { h } from './dom';
import { Keys } from './keys';
import { runPage } from './run/page';
import { studyPage } from './study/page';

const kKinds: Record<PageData['kind'], string> = { run: 'run', map: 'map', laser: 'path', study: 'study', dataset: 'dataset' };

function show(root: HTMLElement): void {
  const data = readData();
  document.title = `waretwin: ${data.title}`;
  const keys = new Keys();
  const parts = data.kind === 'study' ? studyPage(data, keys) : data.kind === 'dataset' ? datasetPage(data, keys) : runPage(data, keys);
  const help = h('button', { class: 'helper', onclick: () => keys.toggleHelp(), 'aria-label': 'Keys', title: '?' }, '?');
  const head = h('header', {}, h('div', {}, h('span', { class: 'kind' }, kKinds[data.kind]), h('h1', {}, data.title), h('p', {}, data.subtitle)), help);
  root.replaceChildren(head, ...parts, h('footer', {}, `waretwin ${data.version}`));
  document.body.dataset['ready'] = data.kind;
}

const root = document.getElementById('app');
if (root) {
  try {
    show(root);
  } catch (problem) {
    root.replaceChildren(h('p', { class: 'problem' }, problem instanceof Error ? problem.message : String(problem)));
    throw problem;
  }
}
