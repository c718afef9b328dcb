// True and mapped cuboids: edges that are seen from afar, faint sides that can be clicked, and a name above.
import * as THREE from 'three';
import type { Box } from '../data';
import { h } from '../dom';
import { colourOfId, colourOfShare, kMapped, kTruth, type Rgb } from '../format';
import type { Colouring } from './mesh';
import { lines, Paint } from './paint';
import type { Item, State } from './state';

// Each name is an element of the page that moves with the view.
export const kMaxNames = 200;

interface Drawn {
  item: Item;
  side: 'truth' | 'mapped';
  group: THREE.Group;
  box: Box;
  lines: THREE.Mesh;
  edges: Paint;
  label: HTMLElement | null;
  height: number; // of the label over the middle, metres
  sides: THREE.Mesh<THREE.BoxGeometry, Paint>;
}

export class Cuboids {
  readonly object = new THREE.Group();
  private readonly drawn: Drawn[] = [];
  // Objects of a moment that the finished map no longer has.
  private readonly passing = new THREE.Group();
  private readonly passingMaterial = new Paint(kMapped, { line: 1.6 });
  // Their names, over the canvas.
  readonly labels = h('div', { class: 'labels' });
  showTruth = true;
  showMapped = true;

  constructor(private readonly state: State) {
    for (const item of state.items) {
      if (item.truth) this.add(item, 'truth', item.truth);
      if (item.mapped) this.add(item, 'mapped', item.mapped);
    }
    this.object.add(this.passing);
    this.colour('photo');
  }

  // Meshes for a ray to hit, with their items.
  get targets(): { mesh: THREE.Mesh; item: Item }[] {
    return this.drawn.filter((d) => d.group.visible).map((d) => ({ mesh: d.sides, item: d.item }));
  }

  placeLabels(camera: THREE.Camera, width: number, height: number): void {
    const at = new THREE.Vector3();
    for (const d of this.drawn) {
      if (!d.label) continue;
      at.copy(d.group.position);
      at.z += d.height;
      at.project(camera);
      d.label.hidden = !d.group.visible || at.z > 1;
      d.label.style.transform = `translate(-50%, -50%) translate(${(((at.x + 1) / 2) * width).toFixed(1)}px, ${(((1 - at.y) / 2) * height).toFixed(1)}px)`;
    }
  }

  colour(by: Colouring): void {
    for (const d of this.drawn) {
      let rgb: Rgb = d.side === 'truth' ? kTruth : kMapped;
      if (d.side === 'mapped' && by === 'label') rgb = colourOfId(d.item.mapped?.id ?? 0);
      if (d.side === 'mapped' && by === 'error' && this.state.data.score) rgb = colourOfShare(d.item.score?.iou3d ?? 0);
      d.edges.setColour(rgb);
      d.sides.material.setColour(rgb);
    }
    this.update();
  }

  // `then`: the map's objects at a moment, as they were; null for those of the finished map.
  update(then: Box[] | null = null): void {
    const known = new Map((then ?? []).map((box) => [box.id, box]));
    for (const d of this.drawn) {
      const box = d.side === 'truth' || then === null ? d.box : known.get(d.box.id);
      const there = box !== undefined;
      if (box) place(d, box);
      d.group.visible = there && (d.side === 'truth' ? this.showTruth : this.showMapped) && !this.state.hidden.has(d.item);
      const chosen = this.state.chosen === d.item;
      d.edges.setWidth(chosen ? 4.5 : 2.2);
      d.sides.material.setOpacity(chosen ? 0.3 : 0.08);
    }
    for (const gone of this.passing.children) (gone as THREE.Mesh).geometry.dispose();
    this.passing.clear();
    if (!this.showMapped) return;
    for (const box of then ?? []) {
      if (this.state.itemOfMapId(box.id)) continue;
      const edges = edgesOf(box.size, this.passingMaterial);
      edges.position.set(...box.centre);
      edges.rotation.z = box.yaw;
      this.passing.add(edges);
    }
  }

  private add(item: Item, side: 'truth' | 'mapped', box: Box): void {
    const shape = new THREE.BoxGeometry(...box.size);
    const edges = new Paint(kMapped, { line: 2.2 });
    const outline = edgesOf(box.size, edges);
    const sides = new THREE.Mesh(shape, new Paint(kMapped, { opacity: 0.08 }));
    const group = new THREE.Group();
    group.add(outline, sides);
    const named = (side === 'mapped' || !item.mapped) && this.labels.childElementCount < kMaxNames;
    const label = named ? h('span', { class: side }, String(box.id)) : null;
    if (label) this.labels.append(label);
    this.object.add(group);
    this.drawn.push({ item, side, group, box, lines: outline, edges, label, height: 0, sides });
  }
}

function edgesOf(size: [number, number, number], material: Paint): THREE.Mesh {
  const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(...size));
  return lines(edges.getAttribute('position').array as Float32Array, material);
}

// Puts what is drawn for one box where another is, at its size.
function place(d: Drawn, box: Box): void {
  d.group.position.set(...box.centre);
  d.group.rotation.z = box.yaw;
  const scale = box.size.map((side, k) => side / Math.max(d.box.size[k] ?? side, 1e-6)) as [number, number, number];
  d.lines.scale.set(...scale);
  d.sides.scale.set(...scale);
  d.height = box.size[2] / 2 + 0.22;
}
