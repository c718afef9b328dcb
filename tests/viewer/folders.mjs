// Folders for the tests, made by the built program in a temporary place that goes away with the test.
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { deflateSync, crc32 as zlibCrc32 } from 'node:zlib';

export function temporaryFolder() {
  const folder = mkdtempSync(path.join(tmpdir(), 'waretwin-viewer-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  return folder;
}

export function waretwin(...words) {
  return execFileSync(process.env.WARETWIN_PROGRAM ?? 'waretwin', words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'inherit'] });
}

// A short drive past the first conveyors of the AgiProbot hall; its folder.
export function drive(folder, ...more) {
  const out = path.join(folder, 'run');
  const scenario = path.join(process.env.WARETWIN_SOURCE_DIR, 'scenes/agiprobot/scenario.yaml');
  waretwin('run', scenario, '--out', out, '--quiet', '--profile', 'paper', '--detector', 'truth', '--rate', '1', '--frames', '240', ...more);
  return out;
}

function crc32(bytes) {
  if (zlibCrc32) return zlibCrc32(bytes);
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

// A PNG of a smooth pattern that differs by `seed`.
export function picture(width, height, seed) {
  const raw = Buffer.alloc(height * (1 + 3 * width));
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const share = 0.5 + 0.5 * Math.sin((x + 40 * seed) / 60) * Math.cos(y / (30 + 4 * seed));
      raw.set([Math.round(255 * (1 - share)), Math.round(200 * share), 80], y * (1 + 3 * width) + 1 + 3 * x);
    }
  }
  const chunk = (type, data) => {
    const body = Buffer.concat([Buffer.from(type), data]);
    const head = Buffer.alloc(4), tail = Buffer.alloc(4);
    head.writeUInt32BE(data.length);
    tail.writeUInt32BE(crc32(body));
    return Buffer.concat([head, body, tail]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2, 0, 0, 0], 8);
  return Buffer.concat([Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), chunk('IHDR', header), chunk('IDAT', deflateSync(raw)), chunk('IEND', Buffer.alloc(0))]);
}

// A study of height and pitch as `waretwin study` writes it, with numbers from a formula. c005 is the best, c000 the baseline, c011 was refused
// and c010 screened out.
export function study(folder) {
  const out = path.join(folder, 'study');
  mkdirSync(path.join(out, 'coverage'), { recursive: true });
  mkdirSync(path.join(out, 'preview'));
  const estimate = (mean, spread) => ({ mean, low: mean - spread, high: mean + spread });
  const candidates = [];
  const heights = [1.2, 1.4, 1.6], pitches = [15, 25, 35, 45];
  for (const height of heights) {
    for (const pitch of pitches) {
      const number = candidates.length, name = `c${String(number).padStart(3, '0')}`;
      const state = number === 11 ? 'refused' : number === 10 ? 'screened_out' : 'run';
      const candidate = { number, name, values: { height, pitch, mount: number % 2 ? 'mast' : 'front' }, state, feasible: state === 'run' && number !== 3, pareto: false, coverage_maps: [] };
      if (state === 'refused') candidate.why = 'height < 1.6 or pitch < 45 does not hold';
      if (state === 'run') {
        const iou = 0.93 - 0.4 * (height - 1.42) ** 2 - 0.0004 * (pitch - 27) ** 2, cover = 0.5 + 0.009 * pitch - 0.1 * (height - 1.2);
        candidate.measures = { mean_iou3d: estimate(iou, 0.02), floor_coverage: estimate(cover, 0.01), e_trans: number === 4 ? null : estimate(0.01 + 0.1 * (1 - iou), 0.002) };
        candidate.runs = [1, 2].map((seed) => ({ hall: 'agiprobot', seed, digest: `d${number}${seed}`, measures: { mean_iou3d: iou + 0.01 * (seed - 1.5), floor_coverage: cover, e_trans: null } }));
        candidate.coverage_maps = [`coverage/${name}-agiprobot.png`];
        writeFileSync(path.join(out, candidate.coverage_maps[0]), picture(640, 400, number));
        writeFileSync(path.join(out, `preview/${name}.png`), picture(640, 360, number + 5));
      }
      candidates.push(candidate);
    }
  }
  const run = candidates.filter((c) => c.state === 'run');
  const baseline = candidates[0];
  for (const c of run.slice(1)) {
    for (const [name, value] of Object.entries(c.measures)) {
      const other = baseline.measures[name];
      if (value && other) value.difference = estimate(value.mean - other.mean, 0.015);
    }
  }
  const feasible = run.filter((c) => c.feasible);
  const best = feasible.reduce((a, b) => (b.measures.mean_iou3d.mean > a.measures.mean_iou3d.mean ? b : a));
  for (const c of feasible) {
    c.pareto = !feasible.some((o) => o !== c && o.measures.mean_iou3d.mean >= c.measures.mean_iou3d.mean && o.measures.floor_coverage.mean >= c.measures.floor_coverage.mean);
  }
  const effects = [];
  for (const measure of ['mean_iou3d', 'floor_coverage']) {
    for (const [factor, levels] of [['height', heights], ['pitch', pitches]]) {
      effects.push({
        factor,
        measure,
        levels: levels.map((level) => {
          const values = run.filter((c) => c.values[factor] === level).map((c) => c.measures[measure].mean);
          const mean = values.reduce((a, b) => a + b, 0) / values.length;
          return { level: String(level), mean, low: mean - 0.03, high: mean + 0.03, runs: 2 * values.length };
        }),
      });
    }
  }
  const results = {
    schema: 'waretwin-study-1', name: 'mounts', description: 'height and pitch of the camera', version: '0.1.0',
    factors: [{ name: 'height', key: 'sensors.cameras.camera.mount.z_m' }, { name: 'pitch', key: 'sensors.cameras.camera.mount.pitch_deg' }, { name: 'mount', key: 'vehicle.mount' }],
    measures: [
      { name: 'mean_iou3d', text: 'mean 3D IoU over all objects of the hall', better: 'more', unit: '' },
      { name: 'floor_coverage', text: 'share of the floor that was seen', better: 'more', unit: '' },
      { name: 'e_trans', text: 'mean translation error', better: 'less', unit: 'm' },
    ],
    best_by: 'mean_iou3d', baseline: 0, best: best.number, halls: ['agiprobot'], seeds: [1, 2], candidates,
    pareto: { measures: ['mean_iou3d', 'floor_coverage'], candidates: feasible.filter((c) => c.pareto).map((c) => c.number) },
    effects, files: ['study.md'],
  };
  writeFileSync(path.join(out, 'results.json'), JSON.stringify(results));
  writeFileSync(path.join(out, 'study.md'), '# mounts\n');
  return { out, best };
}

export function shotPath(name) {
  return path.join(process.env.WARETWIN_SCREENSHOTS ?? tmpdir(), `${name}.png`);
}
