// Points on surfaces that a clip moves: where they are is asked again while it plays.

import type { AnimationState } from "heliograph/messages.ts";
import type { Signal } from "../../common/signal.ts";

const intervalMs = 150;

/** Calls `read` after every change of the animation, and again and again while a clip plays. */
export function followMotion(
  animation: Signal<AnimationState | null>,
  isNeeded: () => boolean,
  read: () => void,
): void {
  let timer: ReturnType<typeof setInterval> | undefined;
  const readIfNeeded = (): void => {
    if (isNeeded()) read();
  };
  animation.watch((state) => {
    clearInterval(timer);
    if (!state?.clip) return;
    readIfNeeded();
    if (state.playing && !state.lockstep) timer = setInterval(readIfNeeded, intervalMs);
  });
}
