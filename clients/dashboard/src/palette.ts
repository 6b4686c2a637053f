// Okabe and Ito's colours, which colour-blind people tell apart, some lighter for a dark ground. No meaning is in colour alone:
// states are words too, and shapes differ.
export const palette = {
  object: "#9fb4c9",
  alive: "#56b4e9",
  awaited: "#f0e442",
  lost: "#ff8a5c",
  detection: "#f5b041",
  track: "#35d0a5",
  cue: "#e69ac4",
  truth: "#7fd6a0",
  ground: "#0f141b",
  text: "#e8edf2",
} as const;

export type State = "alive" | "awaited" | "lost" | "observes";

export const colour_of = (state: string): string =>
  state === "lost" ? palette.lost : state === "awaited" ? palette.awaited : palette.alive;
