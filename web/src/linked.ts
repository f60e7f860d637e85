// Viewers of several runs that show the same view, field, update and instant, in the same colours. Earlier links of each end.

import type { Range } from "./colours";
import type { Viewer } from "./viewer";

export function linked(viewers: Viewer[]): void {
  const widest = new Map<string, Range>();
  for (const [name, [low, high]] of viewers.flatMap((viewer) => [...viewer.ownRanges()])) {
    const known = widest.get(name) ?? [low, high];
    widest.set(name, [Math.min(known[0], low), Math.max(known[1], high)]);
  }
  let isPassing = false;
  // What a viewer takes from another is not passed on.
  const pass = (from: Viewer, act: (other: Viewer) => void) => {
    if (isPassing) return;
    isPassing = true;
    viewers.filter((other) => other !== from).forEach(act);
    isPassing = false;
  };
  for (const viewer of viewers) {
    viewer.widen(widest);
    viewer.stage.onTurn = () => pass(viewer, (other) => other.stage.lookAs(viewer.stage));
    viewer.onChoose = (chosen) => pass(viewer, (other) => other.choose(chosen));
  }
}
