// The map's surface: unpacked once, coloured anew for each way of colouring, drawn up to what a moment has seen.
import * as THREE from 'three';
import { blockBytes, type MeshInfo } from '../data';
import { colourOfError, colourOfId, colourOfShare } from '../format';
import { Paint } from './paint';
import type { State } from './state';

export type Colouring = 'photo' | 'label' | 'error' | 'surface';

// Metres: a surface so far off is as red as can be.
export const kFarOff = 0.03;

const kGrey = [0.62, 0.64, 0.66] as const;

export class MapMesh {
  readonly object: THREE.Mesh;
  readonly labels: Int32Array; // map id of each vertex
  private readonly geometry = new THREE.BufferGeometry();
  private readonly material = new Paint([1, 1, 1], { own: true });
  private readonly positions: Float32Array;
  private readonly photo: Uint8Array;
  private readonly shade: Float32Array;
  private readonly triangles: Uint32Array; // in the order in which they were seen
  private readonly seenAt: Uint8Array; // of each triangle
  private shown: Uint8Array = new Uint8Array(0); // seenAt of those that are not hidden

  constructor(private readonly info: MeshInfo, private readonly state: State) {
    const packed = new Uint16Array(blockBytes('mesh.positions').buffer);
    this.positions = new Float32Array(packed.length);
    for (let i = 0; i < packed.length; ++i) this.positions[i] = info.low[i % 3]! + info.step * packed[i]!;
    this.photo = blockBytes('mesh.colours');
    const numbers = new Uint16Array(blockBytes('mesh.labels').buffer);
    this.labels = Int32Array.from(numbers, (n) => info.label_ids[n] ?? 0);
    const raw = blockBytes('mesh.indices').buffer;
    const indices = info.vertices <= 65536 ? Uint32Array.from(new Uint16Array(raw)) : new Uint32Array(raw);
    this.shade = this.shading(indices);
    [this.triangles, this.seenAt] = this.inOrderOfSight(indices);
    this.geometry.setAttribute('position', new THREE.BufferAttribute(this.positions, 3));
    this.geometry.setAttribute('color', new THREE.BufferAttribute(new Uint8Array(this.photo.length), 3, true));
    this.object = new THREE.Mesh(this.geometry, this.material);
    this.colour('photo');
    this.update();
  }

  // Far parts and parts above the cut are not drawn.
  cutAt(height: number | null): void {
    this.material.setCut(height);
  }

  colour(by: Colouring): void {
    const attribute = this.geometry.getAttribute('color') as THREE.BufferAttribute;
    const colours = attribute.array as Uint8Array;
    if (by === 'surface' && this.info.error_step !== null) {
      this.colourByDistance(colours, this.info.error_step);
      attribute.needsUpdate = true;
      return;
    }
    const ofLabel = new Map<number, readonly [number, number, number]>();
    const pick = (label: number): readonly [number, number, number] => {
      if (label === 0) return kGrey;
      if (by === 'label') return colourOfId(label);
      const score = this.state.itemOfMapId(label)?.score;
      return colourOfShare(score ? score.iou3d : 0);
    };
    for (let i = 0; i < this.labels.length; ++i) {
      const shade = this.shade[i]!;
      if (by === 'photo') {
        for (let k = 0; k < 3; ++k) colours[3 * i + k] = Math.min(255, this.photo[3 * i + k]! * shade);
        continue;
      }
      const label = this.labels[i]!;
      let rgb = ofLabel.get(label);
      if (!rgb) ofLabel.set(label, (rgb = pick(label)));
      for (let k = 0; k < 3; ++k) colours[3 * i + k] = Math.min(255, 255 * rgb[k]! * shade);
    }
    attribute.needsUpdate = true;
  }

  private colourByDistance(colours: Uint8Array, step: number): void {
    const errors = blockBytes('mesh.errors');
    const table = Array.from({ length: 256 }, (_, n) => colourOfError((n * step) / kFarOff));
    for (let i = 0; i < errors.length; ++i) {
      const rgb = table[errors[i]!]!;
      for (let k = 0; k < 3; ++k) colours[3 * i + k] = Math.min(255, 255 * rgb[k]! * this.shade[i]!);
    }
  }

  // Takes hidden objects out of the surface.
  update(): void {
    const hidden = new Set<number>();
    for (const item of this.state.hidden) if (item.mapped) hidden.add(item.mapped.id);
    if (hidden.size === 0) {
      this.geometry.setIndex(new THREE.BufferAttribute(this.triangles, 1));
      this.shown = this.seenAt;
      return;
    }
    const kept = new Uint32Array(this.triangles.length), seen = new Uint8Array(this.seenAt.length);
    let count = 0;
    for (let t = 0; t < this.seenAt.length; ++t) {
      if (hidden.has(this.labels[this.triangles[3 * t]!]!)) continue;
      for (let k = 0; k < 3; ++k) kept[3 * count + k] = this.triangles[3 * t + k]!;
      seen[count++] = this.seenAt[t]!;
    }
    this.geometry.setIndex(new THREE.BufferAttribute(kept.slice(0, 3 * count), 1));
    this.shown = seen.slice(0, count);
  }

  // Draws what the first `frame` + 1 frames have seen; all of it for null.
  growTo(frame: number | null): void {
    let count = this.shown.length;
    if (frame !== null && this.info.seen) {
      // The triangles are in order: the first that was seen later.
      let low = 0;
      while (low < count) {
        const middle = (low + count) >> 1;
        if (this.shown[middle]! <= frame) low = middle + 1;
        else count = middle;
      }
      count = low;
    }
    this.geometry.setDrawRange(0, 3 * count);
  }

  // Light from above and a little from the side, baked in: the surface never moves.
  private shading(indices: Uint32Array): Float32Array {
    const normals = new Float32Array(this.positions.length);
    const p = this.positions;
    for (let t = 0; t < indices.length; t += 3) {
      const a = 3 * indices[t]!, b = 3 * indices[t + 1]!, c = 3 * indices[t + 2]!;
      const ux = p[b]! - p[a]!, uy = p[b + 1]! - p[a + 1]!, uz = p[b + 2]! - p[a + 2]!;
      const vx = p[c]! - p[a]!, vy = p[c + 1]! - p[a + 1]!, vz = p[c + 2]! - p[a + 2]!;
      const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
      for (const v of [a, b, c]) {
        normals[v] = normals[v]! + nx;
        normals[v + 1] = normals[v + 1]! + ny;
        normals[v + 2] = normals[v + 2]! + nz;
      }
    }
    const shade = new Float32Array(p.length / 3);
    for (let i = 0; i < shade.length; ++i) {
      const x = normals[3 * i]!, y = normals[3 * i + 1]!, z = normals[3 * i + 2]!;
      const length = Math.hypot(x, y, z) || 1;
      shade[i] = 0.86 + 0.16 * (z / length) + 0.1 * ((0.5 * x - 0.8 * y) / length);
    }
    return shade;
  }

  private inOrderOfSight(indices: Uint32Array): [Uint32Array, Uint8Array] {
    const count = indices.length / 3;
    if (!this.info.seen) return [indices, new Uint8Array(count)];
    const seen = blockBytes('mesh.seen');
    const at = new Uint8Array(count);
    const first = new Uint32Array(257);
    for (let t = 0; t < count; ++t) {
      at[t] = Math.max(seen[indices[3 * t]!]!, seen[indices[3 * t + 1]!]!, seen[indices[3 * t + 2]!]!);
      first[at[t]! + 1] = first[at[t]! + 1]! + 1;
    }
    for (let k = 1; k < 257; ++k) first[k] = first[k]! + first[k - 1]!;
    const order = new Uint32Array(indices.length), seenAt = new Uint8Array(count);
    for (let t = 0; t < count; ++t) {
      const place = first[at[t]!]!;
      first[at[t]!] = place + 1;
      for (let k = 0; k < 3; ++k) order[3 * place + k] = indices[3 * t + k]!;
      seenAt[place] = at[t]!;
    }
    return [order, seenAt];
  }
}
