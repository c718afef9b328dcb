// The page's data as harness/report/*_page.h describes them, and the binaries beside them.

export interface Box {
  id: number;
  class: string;
  centre: [number, number, number];
  yaw: number;
  size: [number, number, number];
  score?: number;
}

export interface Detection {
  class: string;
  score: number;
  box: [number, number, number, number];
  map_id: number;
}

export type PoseRow = [number, number, number, number, number, number, number]; // x y z qx qy qz qw

export interface Frame {
  frame: number;
  t_s: number;
  sensor: string;
  size: [number, number];
  intrinsics: [number, number, number, number];
  range_m: number;
  X_WC: PoseRow;
  X_WB: PoseRow;
  detections: Detection[];
  objects: Box[];
  colour: string | null;
  depth: string | null;
}

export interface ScoredObject {
  truth_id: number;
  map_id: number | null;
  class: string;
  iou3d: number;
  e_trans_m: number | null;
  e_rot_deg: number | null;
  visible_fraction: number;
  counted: boolean;
}

export interface Summary {
  truth: number;
  mapped: number;
  matched: number;
  recall: number | null;
  precision: number | null;
  mean_iou3d: number | null;
  mean_e_trans_m: number | null;
  mean_e_rot_deg: number | null;
  ap50: number | null;
  map_paper: number | null;
}

export interface DetectionFigures {
  class?: string;
  labels: number;
  precision: number | null;
  recall: number | null;
  ap50: number | null;
  ap: number | null;
  tp: number;
  fp: number;
  fn: number;
}

// score.json; one of another version may lack parts, and the page then shows what there is.
export interface Score {
  scenario: string;
  profile: string;
  seed: number;
  digest: string;
  objects?: ScoredObject[];
  summary?: Partial<Summary>;
  objects_aligned?: ScoredObject[] | null;
  summary_aligned?: Partial<Summary> | null;
  alignment?: { x_m: number; y_m: number; yaw_deg: number } | null;
  explanations?: { truth_id: number | null; map_id: number | null; text: string }[];
  detection?: (DetectionFigures & {
    frames: number;
    match_iou: number;
    classes?: DetectionFigures[];
    confusions?: { truth: string | null; detected: string | null; count: number }[];
  }) | null;
  trajectory?: { ate_rmse_m: number; ate_max_m: number; ate_aligned_rmse_m: number | null } | null;
  surface?: { median_m: number; p95_m: number; found: number; mean_m: number } | null;
  realtime_factor: number;
  frames: { simulated: number; mapped: number; dropped: number };
}

export interface MeshInfo {
  vertices: number;
  triangles: number;
  of_triangles: number;
  low: [number, number, number];
  step: number;
  label_ids: number[];
  floor: number;
  seen: boolean;
  error_step: number | null; // metres; of block mesh.errors
}

export interface PaperRow {
  id: string;
  iou3d: number;
  e_trans_m: number;
  e_rot_deg: number;
}

interface Common {
  schema: string;
  version: string;
  title: string;
  subtitle: string;
  facts: string[];
  files: string[];
  pictures: { caption: string; block: string }[];
}

export interface RunData extends Common {
  kind: 'run' | 'map' | 'laser';
  score: Score | null;
  mapped: Box[];
  truth: Box[];
  path: [number, number, number, number, number][] | null;
  true_path: [number, number, number, number, number][] | null;
  path_error: [number, number, number][] | null;
  timing: {
    stages: { stage: string; mean: number; median: number; p95: number; max: number }[];
    frames: number[][];
  } | null;
  frames: Frame[];
  mesh: MeshInfo | null;
  paper: { table6: PaperRow[]; table4: { name: string; stage: string; cpu: number; gpu: number }[] };
  budget: string | null;
  verdict: string | null;
}

// What follows is results.json as harness/study/study_text.cpp writes it; keys that older ones lack may be missing.
export interface Interval {
  mean: number;
  low: number | null;
  high: number | null;
}

export interface Candidate {
  number: number;
  name: string;
  values: Record<string, number | string>;
  settings?: string[];
  state: 'run' | 'screened_out' | 'refused';
  feasible?: boolean;
  broken?: string[]; // constraints that do not hold, drives that failed
  pareto?: boolean;
  measures?: Record<string, Interval & { difference?: Interval }>; // those that have a value
  runs?: { hall: string; seed: number; digest?: string; error?: string; measures?: Record<string, number> }[];
  coverage_maps?: string[];
  // The page's own, in place of coverage by hall: blocks of pictures.
  coverage?: { caption: string; block: string }[];
  preview?: string | null;
}

export interface Measure {
  name: string;
  text?: string;
  better?: 'more' | 'less';
  source?: 'run' | 'coverage';
}

export interface StudyData extends Common {
  kind: 'study';
  study: {
    name: string;
    description?: string;
    factors: { name: string; key?: string }[];
    measures: Measure[];
    best_by?: string;
    confidence?: number;
    baseline?: number | null;
    best?: number | null;
    verdict?: string;
    halls?: string[];
    seeds?: number[];
    constraints?: string[];
    candidates: Candidate[];
    pareto?: { measures: string[]; candidates: number[] } | null;
    effects?: { factor: string; measure: string; levels: (Interval & { level: string; candidates?: number })[] }[];
  };
}

export interface DatasetImage {
  index: number;
  name: string;
  split: string;
  hall: string;
  kind: string;
  size: [number, number];
  block: string;
  labels: { class: number; box: [number, number, number, number]; amodal_box: [number, number, number, number]; visible: number }[];
  left_out: { class: number; box: [number, number, number, number]; why: string }[];
}

export interface DatasetData extends Common {
  kind: 'dataset';
  dataset: {
    images: number;
    without_labels: number;
    halls: number;
    splits: Record<string, number>;
    views: Record<string, number>;
    left_out: Record<string, number>;
    classes: { name: string; labels: number; sides: number[]; visible: number[] }[];
  };
  images: DatasetImage[];
}

export type PageData = RunData | StudyData | DatasetData;

export function readData(): PageData {
  const element = document.getElementById('waretwin-data');
  if (!element?.textContent) throw new Error('this page holds no data: `waretwin report DIR` makes one that does');
  const data = JSON.parse(element.textContent) as PageData;
  if (data.schema !== 'waretwin-page-1') throw new Error(`data of schema ${String(data.schema)}; expected waretwin-page-1`);
  return data;
}

function blockText(name: string): string | null {
  return document.getElementById(`block:${name}`)?.textContent ?? null;
}

// A picture as the address of an <img>; null where there is none.
export function pictureUrl(name: string | null): string | null {
  const text = name === null ? null : blockText(name);
  return text === null ? null : `data:image/jpeg;base64,${text}`;
}

export function blockBytes(name: string): Uint8Array {
  const text = blockText(name);
  if (text === null) throw new Error(`the page has no block ${name}`);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}
