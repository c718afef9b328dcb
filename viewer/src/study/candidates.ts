// What the parts of a study's page ask of its candidates and measures, and which candidate is chosen.
import type { Candidate, Measure, StudyData } from '../data';
import { short } from '../format';

type Study = StudyData['study'];

export class Choice {
  candidate: Candidate | null = null;
  private readonly listeners: (() => void)[] = [];
  when(listener: () => void): void {
    this.listeners.push(listener);
  }
  choose(candidate: Candidate | null): void {
    this.candidate = candidate;
    for (const listener of this.listeners) listener();
  }
}

export function meanOf(candidate: Candidate | null | undefined, measure: string): number | null {
  return candidate?.measures?.[measure]?.mean ?? null;
}

// By a drive or by coverage alone: a candidate that was screened out still has its coverage.
export function isMeasured(candidate: Candidate): boolean {
  return Object.keys(candidate.measures ?? {}).some((name) => meanOf(candidate, name) !== null);
}

export function anyDriven(study: Study): boolean {
  return study.candidates.some((candidate) => candidate.state === 'run');
}

// Those that some candidate has a value of. A study without drives is judged by coverage, which its list of measures need not hold.
export function measuresWithValues(study: Study): Measure[] {
  const others = [study.best_by, ...(study.pareto?.measures ?? [])].filter((name): name is string => name !== undefined);
  const all: Measure[] = [...study.measures];
  for (const name of others) if (!all.some((measure) => measure.name === name)) all.push({ name });
  return all.filter((measure) => study.candidates.some((candidate) => meanOf(candidate, measure.name) !== null));
}

export function wordsOf(name: string): string {
  return name.replaceAll('_', ' ');
}

export function brokenText(candidate: Candidate): string {
  return (candidate.broken ?? []).join('; ');
}

export function settingsText(study: Study, candidate: Candidate): string {
  return study.factors.map((factor) => `${factor.name} ${String(candidate.values[factor.name] ?? '–')}`).join(', ');
}

// "95 %"; nothing where the study does not say.
export function confidenceText(study: Study): string {
  return study.confidence === undefined ? '' : `${short(100 * study.confidence)} %`;
}
