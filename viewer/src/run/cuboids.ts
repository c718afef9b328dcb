// True and mapped cuboids: edges that are seen from afar, faint sides that can be clicked, and a name above.
import * as THREE from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Box } from '../data';
import { colourOfId, colourOfShare, kMapped, kTruth, type Rgb } from '../format';
import type { Colouring } from './mesh';
import type { Item, State } from './state';

interface Drawn {
  item: Item;
  side: 'truth' | 'mapped';
  group: THREE.Group;
  box: Box;
  lines: LineSegments2;
  edges: LineMaterial;
  label: THREE.Sprite | null;
  sides: THREE.Mesh<THREE.BoxGeometry, THREE.MeshBasicMaterial>;
}

export class Cuboids {
  readonly object = new THREE.Group();
  private readonly drawn: Drawn[] = [];
  // Objects of a moment that the finished map no longer has.
  private readonly passing = new THREE.Group();
  private readonly passingMaterial = new LineMaterial({ linewidth: 1.6, color: new THREE.Color(...kMapped).getHex(THREE.LinearSRGBColorSpace) });
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

  setResolution(width: number, height: number): void {
    for (const d of this.drawn) d.edges.resolution.set(width, height);
    this.passingMaterial.resolution.set(width, height);
  }

  colour(by: Colouring): void {
    for (const d of this.drawn) {
      let rgb: Rgb = d.side === 'truth' ? kTruth : kMapped;
      if (d.side === 'mapped' && by === 'label') rgb = colourOfId(d.item.mapped?.id ?? 0);
      if (d.side === 'mapped' && by === 'error' && this.state.data.score) rgb = colourOfShare(d.item.score?.iou3d ?? 0);
      d.edges.color.setRGB(...rgb);
      d.sides.material.color.setRGB(...rgb);
    }
    this.update();
  }

  // `then`: the map's objects at a moment, as they were; null for those of the finished map.
  update(then: Box[] | null = null): void {
    for (const d of this.drawn) {
      const box = d.side === 'truth' || then === null ? d.box : then.find((each) => each.id === d.box.id);
      const there = box !== undefined;
      if (box) place(d, box);
      d.group.visible = there && (d.side === 'truth' ? this.showTruth : this.showMapped) && !this.state.hidden.has(d.item);
      const chosen = this.state.chosen === d.item;
      d.edges.linewidth = chosen ? 4.5 : 2.2;
      d.sides.material.opacity = chosen ? 0.3 : 0.08;
    }
    for (const lines of this.passing.children) (lines as LineSegments2).geometry.dispose();
    this.passing.clear();
    if (!this.showMapped) return;
    for (const box of then ?? []) {
      if (this.state.itemOfMapId(box.id)) continue;
      const lines = edgesOf(box.size, this.passingMaterial);
      lines.position.set(...box.centre);
      lines.rotation.z = box.yaw;
      this.passing.add(lines);
    }
  }

  private add(item: Item, side: 'truth' | 'mapped', box: Box): void {
    const shape = new THREE.BoxGeometry(...box.size);
    const edges = new LineMaterial({ linewidth: 2.2 });
    const lines = edgesOf(box.size, edges);
    const sides = new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.08, depthWrite: false }));
    const group = new THREE.Group();
    group.add(lines, sides);
    const label = side === 'mapped' || !item.mapped ? nameSprite(`${box.id}`, side) : null;
    if (label) group.add(label);
    this.object.add(group);
    this.drawn.push({ item, side, group, box, lines, edges, label, sides });
  }
}

function edgesOf(size: [number, number, number], material: LineMaterial): LineSegments2 {
  return new LineSegments2(new LineSegmentsGeometry().fromEdgesGeometry(new THREE.EdgesGeometry(new THREE.BoxGeometry(...size))), material);
}

// Puts what is drawn for one box where another is, at its size.
function place(d: Drawn, box: Box): void {
  d.group.position.set(...box.centre);
  d.group.rotation.z = box.yaw;
  const scale = box.size.map((side, k) => side / Math.max(d.box.size[k] ?? side, 1e-6)) as [number, number, number];
  d.lines.scale.set(...scale);
  d.sides.scale.set(...scale);
  if (d.label) d.label.position.z = box.size[2] / 2 + 0.22;
}

function nameSprite(text: string, side: 'truth' | 'mapped'): THREE.Sprite {
  const canvas = document.createElement('canvas');
  canvas.width = 96;
  canvas.height = 56;
  const pen = canvas.getContext('2d');
  if (pen) {
    pen.fillStyle = side === 'truth' ? 'rgb(23 120 75 / 92%)' : 'rgb(30 34 40 / 86%)';
    pen.beginPath();
    pen.roundRect(4, 4, 88, 48, 14);
    pen.fill();
    pen.fillStyle = '#fff';
    pen.font = '600 32px system-ui, sans-serif';
    pen.textAlign = 'center';
    pen.textBaseline = 'middle';
    pen.fillText(text, 48, 29);
  }
  const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(canvas), depthTest: false, sizeAttenuation: false }));
  sprite.scale.set(0.048, 0.028, 1);
  sprite.renderOrder = 10;
  return sprite;
}
