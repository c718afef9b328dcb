// The hall in 3D: surface, cuboids, path. Draws when something changed, and only then.
import * as THREE from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { h } from '../dom';
import { Cuboids } from './cuboids';
import { Drive } from './drive';
import { screen } from './paint';
import { MapMesh, type Colouring } from './mesh';
import type { Item, State } from './state';

export type Layer = 'mesh' | 'truth' | 'mapped' | 'path' | 'cut' | 'grow';

// How many pixels are drawn for one of the screen: more smooth the edges. Without a graphics card the processor draws them all, and one must do.
function pixelRatioOf(renderer: THREE.WebGLRenderer): number {
  const context = renderer.getContext();
  const info = context.getExtension('WEBGL_debug_renderer_info');
  const card = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  return /swiftshader|llvmpipe|software/i.test(card) ? 1 : Math.min(2, 1.5 * window.devicePixelRatio);
}

export class View3d {
  readonly element = h('div', { class: 'canvas' });
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(50, 1, 0.05, 500);
  private readonly controls: OrbitControls;
  private readonly mesh: MapMesh | null;
  private readonly cuboids: Cuboids;
  private readonly drive: Drive;
  private readonly layers: Record<Layer, boolean> = { mesh: true, truth: true, mapped: true, path: true, cut: true, grow: false };
  private cutHeight: number;
  private asked = false;
  private compiled = false;
  private pressed: { x: number; y: number } | null = null;

  // Throws where the browser has no WebGL.
  constructor(private readonly state: State) {
    THREE.ColorManagement.enabled = false;
    const canvas = h('canvas', { tabindex: 0, 'aria-label': 'The map in 3D: drag to turn, wheel to come nearer, click an object to choose it' });
    // Kept after drawing, so that a screenshot or a copy of the canvas is never empty.
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, preserveDrawingBuffer: true });
    // Asking for errors would wait for each shader in turn.
    this.renderer.debug.checkShaderErrors = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setPixelRatio(pixelRatioOf(this.renderer));
    this.element.append(canvas);
    this.mesh = state.data.mesh ? new MapMesh(state.data.mesh, state) : null;
    this.cuboids = new Cuboids(state);
    this.element.append(this.cuboids.labels);
    this.drive = new Drive(state);
    if (this.mesh) this.scene.add(this.mesh.object);
    this.scene.add(this.cuboids.object, this.drive.object);
    this.cutHeight = (state.data.mesh?.floor ?? 0) + 2.4;
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI;
    this.controls.addEventListener('change', () => this.ask());
    this.resetView();
    this.setTheme();
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.setTheme());
    canvas.addEventListener('pointerdown', (event) => (this.pressed = { x: event.clientX, y: event.clientY }));
    canvas.addEventListener('pointerup', (event) => this.onRelease(event));
    new ResizeObserver(() => this.resize()).observe(this.element);
    // Shaders are made side by side; then it is drawn for the first time.
    void this.renderer.compileAsync(this.scene, this.camera).then(() => {
      this.compiled = true;
      this.ask();
    });
    state.whenChosen(() => this.refresh());
    state.whenFrame(() => this.refresh());
    state.whenHidden(() => {
      this.mesh?.update();
      this.refresh();
    });
    this.refresh();
  }

  get cut(): { low: number; high: number; at: number } {
    const floor = this.state.data.mesh?.floor ?? 0;
    return { low: floor + 0.2, high: floor + 6, at: this.cutHeight };
  }

  shows(layer: Layer): boolean {
    return this.layers[layer];
  }
  show(layer: Layer, on: boolean): void {
    this.layers[layer] = on;
    this.refresh();
  }
  setCut(height: number): void {
    this.cutHeight = height;
    this.refresh();
  }
  colour(by: Colouring): void {
    this.mesh?.colour(by);
    this.cuboids.colour(by);
    this.refresh();
  }

  // From outside on the long side, so that the hall fills the picture.
  resetView(): void {
    const box = this.bounds();
    const size = box.getSize(new THREE.Vector3()), middle = box.getCenter(new THREE.Vector3());
    // A path alone is flat.
    const flat = !this.mesh && this.state.items.length === 0;
    const away = flat ? new THREE.Vector3(0, -0.01, 1) : size.x >= size.y ? new THREE.Vector3(-0.25, -0.72, 0.8) : new THREE.Vector3(-0.72, -0.25, 0.8);
    this.controls.target.copy(middle).setZ(box.min.z + 0.4 * Math.min(size.z, 2));
    this.camera.position.copy(this.controls.target).addScaledVector(away.normalize(), 0.64 * Math.max(3, Math.hypot(size.x, size.y)));
    this.controls.update();
    this.ask();
  }

  focus(item: Item): void {
    const box = item.mapped ?? item.truth;
    if (!box) return;
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    this.controls.target.set(...box.centre);
    this.camera.position.copy(this.controls.target).addScaledVector(direction, 2.2 + 1.6 * Math.max(...box.size));
    this.controls.update();
    this.ask();
  }

  turn(right: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const round = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    round.theta += right;
    round.phi = Math.min(Math.PI - 0.05, Math.max(0.05, round.phi + up));
    const turned = new THREE.Vector3().setFromSpherical(round);
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.ask();
  }

  zoom(factor: number): void {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.ask();
  }

  // Where an object's middle is on the screen, in pixels of the page; for tests and labels.
  screenOf(item: Item): { x: number; y: number } | null {
    const box = item.mapped ?? item.truth;
    if (!box) return null;
    this.camera.updateMatrixWorld();
    const at = new THREE.Vector3(box.centre[0], box.centre[1], box.centre[2] + 0.3 * box.size[2]).project(this.camera);
    const frame = this.element.getBoundingClientRect();
    return { x: frame.left + ((at.x + 1) / 2) * frame.width, y: frame.top + ((1 - at.y) / 2) * frame.height };
  }

  private bounds(): THREE.Box3 {
    const box = new THREE.Box3();
    for (const item of this.state.items) {
      for (const cuboid of [item.truth, item.mapped]) {
        if (!cuboid) continue;
        const reach = new THREE.Vector3(Math.hypot(cuboid.size[0], cuboid.size[1]) / 2, Math.hypot(cuboid.size[0], cuboid.size[1]) / 2, cuboid.size[2] / 2);
        const centre = new THREE.Vector3(...cuboid.centre);
        box.union(new THREE.Box3(centre.clone().sub(reach), centre.clone().add(reach)));
      }
    }
    for (const path of [this.state.data.path, this.state.data.true_path]) {
      for (const row of path ?? []) box.expandByPoint(new THREE.Vector3(row[1], row[2], row[3]));
    }
    if (this.state.data.mesh && this.mesh) {
      // All but the outermost two percent: single far points would make the rest small.
      const p = this.mesh.object.geometry.getAttribute('position').array;
      const few: number[][] = [[], [], []];
      const step = 3 * Math.max(1, Math.floor(p.length / 3 / 4000));
      for (let i = 0; i + 2 < p.length; i += step) for (let k = 0; k < 3; ++k) few[k]!.push(p[i + k]!);
      for (const list of few) list.sort((a, b) => a - b);
      const at = (share: number): THREE.Vector3 => new THREE.Vector3(...few.map((list) => list[Math.floor(share * (list.length - 1))] ?? 0));
      box.union(new THREE.Box3(at(0.02), at(0.98)));
    }
    if (box.isEmpty()) box.set(new THREE.Vector3(-1, -1, 0), new THREE.Vector3(1, 1, 1));
    return box;
  }

  private onRelease(event: PointerEvent): void {
    const from = this.pressed;
    this.pressed = null;
    if (!from || event.button !== 0 || Math.hypot(event.clientX - from.x, event.clientY - from.y) > 4) return;
    this.state.choose(this.pick(event.clientX, event.clientY));
  }

  // The nearest cuboid under a point that the surface does not hide; else the object whose surface is there.
  private pick(x: number, y: number): Item | null {
    const frame = this.element.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * (x - frame.left)) / frame.width - 1, 1 - (2 * (y - frame.top)) / frame.height), this.camera);
    const surface = this.mesh && this.layers.mesh ? ray.intersectObject(this.mesh.object).find((hit) => !this.layers.cut || hit.point.z <= this.cutHeight) : undefined;
    const targets = this.cuboids.targets;
    const hits = ray.intersectObjects(targets.map((target) => target.mesh), false);
    const reach = (surface?.distance ?? Infinity) + 0.25;
    const hit = hits.find((each) => each.distance <= reach);
    if (hit) return targets.find((target) => target.mesh === hit.object)?.item ?? null;
    const label = surface?.face && this.mesh ? this.mesh.labels[surface.face.a] : 0;
    return label ? this.state.itemOfMapId(label) : null;
  }

  private refresh(): void {
    const grows = this.layers.grow;
    const frame = this.state.data.frames[this.state.frame];
    if (this.mesh) {
      this.mesh.object.visible = this.layers.mesh;
      this.mesh.cutAt(this.layers.cut ? this.cutHeight : null);
      this.mesh.growTo(grows && frame ? this.state.frame : null);
    }
    this.cuboids.showTruth = this.layers.truth;
    this.cuboids.showMapped = this.layers.mapped;
    this.cuboids.update(grows && frame ? frame.objects : null);
    this.drive.showPath = this.layers.path;
    this.drive.update();
    this.ask();
  }

  private setTheme(): void {
    const dark = window.matchMedia('(prefers-color-scheme: dark)').matches;
    this.renderer.setClearColor(dark ? 0x15181c : 0xeef0f2);
    this.ask();
  }

  private resize(): void {
    const width = this.element.clientWidth, height = this.element.clientHeight;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    screen.value.set(width, height);
    this.ask();
  }

  private ask(): void {
    if (this.asked || !this.compiled) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.renderer.render(this.scene, this.camera);
      this.cuboids.placeLabels(this.camera, this.element.clientWidth, this.element.clientHeight);
    });
  }
}
