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
  edges: LineMaterial;
  sides: THREE.Mesh<THREE.BoxGeometry, THREE.MeshBasicMaterial>;
}

export class Cuboids {
  readonly object = new THREE.Group();
  private readonly drawn: Drawn[] = [];
  showTruth = true;
  showMapped = true;

  constructor(private readonly state: State) {
    for (const item of state.items) {
      if (item.truth) this.add(item, 'truth', item.truth);
      if (item.mapped) this.add(item, 'mapped', item.mapped);
    }
    this.colour('photo');
  }

  // Meshes for a ray to hit, with their items.
  get targets(): { mesh: THREE.Mesh; item: Item }[] {
    return this.drawn.filter((d) => d.group.visible).map((d) => ({ mesh: d.sides, item: d.item }));
  }

  setResolution(width: number, height: number): void {
    for (const d of this.drawn) d.edges.resolution.set(width, height);
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

  // `known`: ids of the objects that the map had at the moment; null for all.
  update(known: Set<number> | null = null): void {
    for (const d of this.drawn) {
      const there = d.side === 'truth' || known === null || known.has(d.item.mapped?.id ?? 0);
      d.group.visible = there && (d.side === 'truth' ? this.showTruth : this.showMapped) && !this.state.hidden.has(d.item);
      const chosen = this.state.chosen === d.item;
      d.edges.linewidth = chosen ? 4.5 : 2.2;
      d.sides.material.opacity = chosen ? 0.3 : 0.08;
    }
  }

  private add(item: Item, side: 'truth' | 'mapped', box: Box): void {
    const shape = new THREE.BoxGeometry(...box.size);
    const edges = new LineMaterial({ linewidth: 2.2 });
    const lines = new LineSegments2(new LineSegmentsGeometry().fromEdgesGeometry(new THREE.EdgesGeometry(shape)), edges);
    const sides = new THREE.Mesh(shape, new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.08, depthWrite: false }));
    const group = new THREE.Group();
    group.add(lines, sides);
    group.position.set(...box.centre);
    group.rotation.z = box.yaw;
    if (side === 'mapped' || !item.mapped) {
      const label = nameSprite(`${box.id}`, side);
      label.position.z = box.size[2] / 2 + 0.22;
      group.add(label);
    }
    this.object.add(group);
    this.drawn.push({ item, side, group, edges, sides });
  }
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
