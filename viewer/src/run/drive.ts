// The robot's path, as estimated and as it was, and where robot and camera are at a moment.
import * as THREE from 'three';
import { Line2 } from 'three/examples/jsm/lines/Line2.js';
import { LineGeometry } from 'three/examples/jsm/lines/LineGeometry.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import type { Frame, PoseRow } from '../data';
import { kPath, kTruePath, type Rgb } from '../format';
import type { State } from './state';

export class Drive {
  readonly object = new THREE.Group();
  private readonly paths = new THREE.Group();
  private readonly materials: LineMaterial[] = [];
  private readonly marker = new THREE.Group();
  private readonly field = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: new THREE.Color(0.95, 0.68, 0.1) }));

  constructor(private readonly state: State) {
    if (state.data.true_path) this.addPath(state.data.true_path, kTruePath, 2, 0.03);
    if (state.data.path) this.addPath(state.data.path, kPath, 2.6, 0.05);
    const body = new THREE.Mesh(new THREE.CylinderGeometry(0.22, 0.22, 0.18, 28), new THREE.MeshBasicMaterial({ color: new THREE.Color(...kPath) }));
    body.rotation.x = Math.PI / 2;
    body.position.z = 0.12;
    const nose = new THREE.Mesh(new THREE.ConeGeometry(0.11, 0.26, 20), new THREE.MeshBasicMaterial({ color: new THREE.Color(0.95, 0.68, 0.1) }));
    nose.rotation.z = -Math.PI / 2;
    nose.position.set(0.26, 0, 0.12);
    this.marker.add(body, nose);
    this.object.add(this.paths, this.marker, this.field);
    this.update();
  }

  set showPath(on: boolean) {
    this.paths.visible = on;
  }

  setResolution(width: number, height: number): void {
    for (const material of this.materials) material.resolution.set(width, height);
  }

  update(): void {
    const frame = this.state.data.frames[this.state.frame];
    this.marker.visible = this.field.visible = frame !== undefined;
    if (!frame) return;
    const X_WB = poseOf(frame.X_WB);
    this.marker.position.copy(X_WB.position);
    this.marker.quaternion.copy(X_WB.quaternion);
    // A recording by hand has no vehicle: its poses are the camera's.
    const onVehicle = X_WB.position.distanceTo(poseOf(frame.X_WC).position) > 0.01;
    this.marker.visible = onVehicle;
    this.field.geometry.dispose();
    this.field.geometry = new THREE.BufferGeometry().setFromPoints(fieldOf(frame, onVehicle ? 1.2 : 0.5));
  }

  private addPath(rows: number[][], rgb: Rgb, width: number, lift: number): void {
    if (rows.length < 2) return;
    const points = rows.flatMap((row) => [row[1]!, row[2]!, row[3]! + lift]);
    const material = new LineMaterial({ linewidth: width, color: new THREE.Color(...rgb).getHex(THREE.LinearSRGBColorSpace) });
    this.materials.push(material);
    this.paths.add(new Line2(new LineGeometry().setPositions(points), material));
  }
}

export function poseOf(row: PoseRow): { position: THREE.Vector3; quaternion: THREE.Quaternion } {
  return { position: new THREE.Vector3(row[0], row[1], row[2]), quaternion: new THREE.Quaternion(row[3], row[4], row[5], row[6]) };
}

// The pyramid that the camera sees, as pairs of points.
function fieldOf(frame: Frame, depth: number): THREE.Vector3[] {
  const [fx, fy, cx, cy] = frame.intrinsics;
  const [width, height] = frame.size;
  const X_WC = poseOf(frame.X_WC);
  const corner = (u: number, v: number): THREE.Vector3 =>
    new THREE.Vector3(((u - cx) / fx) * depth, ((v - cy) / fy) * depth, depth).applyQuaternion(X_WC.quaternion).add(X_WC.position);
  const corners = [corner(0, 0), corner(width, 0), corner(width, height), corner(0, height)];
  return corners.flatMap((c, i) => [X_WC.position, c, c, corners[(i + 1) % 4]!]);
}
