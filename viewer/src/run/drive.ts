// The robot's path, as estimated and as it was, and where robot and camera are at a moment.
import * as THREE from 'three';
import type { Frame, PoseRow } from '../data';
import { kPath, kTruePath, type Rgb } from '../format';
import { lineGeometry, lines, Paint } from './paint';
import type { State } from './state';

const kNose: Rgb = [0.95, 0.68, 0.1];

export class Drive {
  readonly object = new THREE.Group();
  private readonly paths = new THREE.Group();
  private readonly marker = new THREE.Group();
  private readonly field = lines([], new Paint(kNose, { line: 1.4 }));

  constructor(private readonly state: State) {
    if (state.data.true_path) this.addPath(state.data.true_path, kTruePath, 2, 0.03);
    if (state.data.path) this.addPath(state.data.path, kPath, 2.6, 0.05);
    const body = new THREE.Mesh(new THREE.CylinderGeometry(0.22, 0.22, 0.18, 28), new Paint(kPath));
    body.rotation.x = Math.PI / 2;
    body.position.z = 0.12;
    const nose = new THREE.Mesh(new THREE.ConeGeometry(0.11, 0.26, 20), new Paint(kNose));
    nose.rotation.z = -Math.PI / 2;
    nose.position.set(0.26, 0, 0.12);
    this.marker.add(body, nose);
    this.object.add(this.paths, this.marker, this.field);
    this.update();
  }

  set showPath(on: boolean) {
    this.paths.visible = on;
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
    const points = fieldOf(frame, onVehicle ? 1.2 : 0.5).flatMap((p) => [p.x, p.y, p.z]);
    this.field.geometry = lineGeometry(points);
  }

  private addPath(rows: number[][], rgb: Rgb, width: number, lift: number): void {
    if (rows.length < 2) return;
    const pairs = new Float32Array(6 * (rows.length - 1));
    for (let i = 0; i + 1 < rows.length; ++i) {
      [rows[i]!, rows[i + 1]!].forEach((row, k) => pairs.set([row[1]!, row[2]!, row[3]! + lift], 6 * i + 3 * k));
    }
    this.paths.add(lines(pairs, new Paint(rgb, { line: width })));
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
