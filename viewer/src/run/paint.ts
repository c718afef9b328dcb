// The 3D view's two materials. Every shader has to be made before the first picture, and three.js's own do far more than is needed here: these
// open the page a second sooner where the processor draws.
import * as THREE from 'three';
import type { Rgb } from '../format';

const kVertex = `
precision highp float;
uniform mat4 projectionMatrix, modelViewMatrix, modelMatrix;
uniform vec3 tint;
uniform float own;
in vec3 position, color;
out vec3 colour;
out float height;
void main() {
  colour = mix(tint, color, own);
  height = (modelMatrix * vec4(position, 1.0)).z;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// Lines have a width in pixels: each is a rectangle that lies across the screen. Ends before the camera are cut off.
const kLineVertex = `
precision highp float;
uniform mat4 projectionMatrix, modelViewMatrix;
uniform vec3 tint;
uniform float width;
uniform vec2 screen;
in vec3 position, from, to;
out vec3 colour;
out float height;
void main() {
  colour = tint;
  height = -1e9;
  vec4 a = projectionMatrix * modelViewMatrix * vec4(from, 1.0), b = projectionMatrix * modelViewMatrix * vec4(to, 1.0);
  if (a.w < 0.05 && b.w > 0.05) a = mix(a, b, (0.05 - a.w) / (b.w - a.w));
  if (b.w < 0.05 && a.w > 0.05) b = mix(b, a, (0.05 - b.w) / (a.w - b.w));
  vec2 along = (b.xy / b.w - a.xy / a.w) * screen;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  vec4 end = position.x < 0.5 ? a : b;
  vec2 aside = vec2(-along.y, along.x) * position.y + along * (position.x - 0.5) * 0.8;
  end.xy += aside * width / screen * end.w;
  gl_Position = end;
}`;

const kFragment = `
precision highp float;
uniform float opacity, cut;
in vec3 colour;
in float height;
out vec4 shown;
void main() {
  if (height > cut) discard;
  shown = vec4(colour, opacity);
}`;

const kNoCut = 1e9;

// Of the canvas, in pixels of the page; shared by all lines.
export const screen = { value: new THREE.Vector2(1, 1) };

export class Paint extends THREE.RawShaderMaterial {
  // `own`: the colours are the geometry's.
  constructor(rgb: Rgb, { opacity = 1, own = false, line = 0 } = {}) {
    super({
      glslVersion: THREE.GLSL3,
      vertexShader: line > 0 ? kLineVertex : kVertex,
      fragmentShader: kFragment,
      uniforms: {
        tint: { value: new THREE.Vector3(...rgb) },
        opacity: { value: opacity },
        own: { value: own ? 1 : 0 },
        cut: { value: kNoCut },
        width: { value: line },
        screen,
      },
      side: THREE.DoubleSide,
      transparent: opacity < 1,
      depthWrite: opacity === 1,
    });
  }
  setColour(rgb: Rgb): void {
    (this.uniforms['tint']!.value as THREE.Vector3).set(...rgb);
  }
  setOpacity(opacity: number): void {
    this.uniforms['opacity']!.value = opacity;
  }
  setWidth(width: number): void {
    this.uniforms['width']!.value = width;
  }
  // Nothing higher is drawn; null: all is.
  setCut(height: number | null): void {
    this.uniforms['cut']!.value = height ?? kNoCut;
  }
}

// Lines between pairs of points: x, y, z, x, y, z, ...
export function lines(pairs: Float32Array | number[], material: Paint): THREE.Mesh {
  const mesh = new THREE.Mesh(lineGeometry(pairs), material);
  mesh.frustumCulled = false; // its corners are not where its lines are
  return mesh;
}

export function lineGeometry(pairs: Float32Array | number[]): THREE.InstancedBufferGeometry {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array([0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const both = new THREE.InstancedInterleavedBuffer(pairs instanceof Float32Array ? pairs : new Float32Array(pairs), 6);
  geometry.setAttribute('from', new THREE.InterleavedBufferAttribute(both, 3, 0));
  geometry.setAttribute('to', new THREE.InterleavedBufferAttribute(both, 3, 3));
  geometry.instanceCount = pairs.length / 6;
  return geometry;
}
