// What is chosen on a run's page: an object and a moment. Parts of the page listen.
import type { Box, RunData, ScoredObject } from '../data';

// A true object with the mapped one that belongs to it, or one of the two alone.
export interface Item {
  key: string;
  class: string;
  truth: Box | null;
  mapped: Box | null;
  score: ScoredObject | null;
}

export function itemsOf(data: RunData): Item[] {
  const items: Item[] = [];
  const taken = new Set<number>();
  const truths = new Map(data.truth.map((box) => [box.id, box])), maps = new Map(data.mapped.map((box) => [box.id, box]));
  for (const scored of data.score?.objects ?? []) {
    const truth = truths.get(scored.truth_id) ?? null;
    const mapped = scored.map_id === null ? null : (maps.get(scored.map_id) ?? null);
    if (mapped) taken.add(mapped.id);
    items.push({ key: `t${scored.truth_id}`, class: scored.class, truth, mapped, score: scored });
  }
  // A score without a list of objects still has its true ones.
  if (data.score && !data.score.objects) for (const truth of truths.values()) items.push({ key: `t${truth.id}`, class: truth.class, truth, mapped: null, score: null });
  for (const mapped of data.mapped) {
    if (!taken.has(mapped.id)) items.push({ key: `m${mapped.id}`, class: mapped.class, truth: null, mapped, score: null });
  }
  return items;
}

export function nameOf(item: Item): string {
  const id = item.truth && item.mapped ? `${item.truth.id} (map ${item.mapped.id})` : item.truth ? `${item.truth.id}, ${item.score ? 'not mapped' : 'not scored'}` : `map ${item.mapped?.id ?? '?'}`;
  return `${item.class} ${id}`;
}

type Listener = () => void;

export class State {
  readonly items: Item[];
  chosen: Item | null = null;
  frame = 0; // index into data.frames
  readonly hidden = new Set<Item>();
  private readonly byMapId: Map<number, Item>;
  private readonly onChoice: Listener[] = [];
  private readonly onFrame: Listener[] = [];
  private readonly onHidden: Listener[] = [];

  constructor(readonly data: RunData) {
    this.items = itemsOf(data);
    this.byMapId = new Map(this.items.flatMap((item): [number, Item][] => (item.mapped ? [[item.mapped.id, item]] : [])));
    this.frame = Math.max(0, data.frames.length - 1);
  }

  get time(): number {
    return this.data.frames[this.frame]?.t_s ?? 0;
  }

  whenChosen(listener: Listener): void {
    this.onChoice.push(listener);
  }
  whenFrame(listener: Listener): void {
    this.onFrame.push(listener);
  }
  whenHidden(listener: Listener): void {
    this.onHidden.push(listener);
  }

  choose(item: Item | null): void {
    this.chosen = item;
    for (const listener of this.onChoice) listener();
  }

  toggleHidden(item: Item): void {
    if (!this.hidden.delete(item)) this.hidden.add(item);
    for (const listener of this.onHidden) listener();
  }
  showAll(): void {
    this.hidden.clear();
    for (const listener of this.onHidden) listener();
  }

  setFrame(index: number): void {
    const last = this.data.frames.length - 1;
    const next = Math.min(last, Math.max(0, index));
    if (last < 0 || next === this.frame) return;
    this.frame = next;
    for (const listener of this.onFrame) listener();
  }

  setTime(t: number): void {
    let best = 0;
    this.data.frames.forEach((frame, i) => {
      if (Math.abs(frame.t_s - t) < Math.abs((this.data.frames[best]?.t_s ?? 0) - t)) best = i;
    });
    this.setFrame(best);
  }

  itemOfMapId(id: number): Item | null {
    return this.byMapId.get(id) ?? null;
  }
}
