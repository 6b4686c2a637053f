// How fast simulated time passes: a list of factors of real time, of which the clock's own is always one.
const factors = [0.1, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const unlimited = 0; // as fast as the nodes are

const text_of = (factor: number): string => (factor === unlimited ? "as fast as it goes" : `${+factor.toPrecision(4)} \u00d7 real time`);

export class Speed {
  private listed: number[] = [];

  constructor(private readonly list: HTMLSelectElement, private readonly ask: (factor: number) => void) {
    this.show(unlimited);
    list.onchange = () => ask(Number(list.value));
  }

  /** Shows the clock's pace. */
  show(factor: number): void {
    const wanted = factors.includes(factor) || factor === unlimited ? factors : [...factors, factor].sort((a, b) => a - b);
    if (wanted.join() !== this.listed.join()) {
      this.list.replaceChildren(...[...wanted, unlimited].map((f) => new Option(text_of(f), String(f))));
      this.listed = wanted;
    }
    this.list.value = String(factor);
  }

  /** The next slower (-1) or faster (1). */
  move(by: number): void {
    const all = [...this.list.options].map((option) => Number(option.value));
    const next = all[all.indexOf(Number(this.list.value)) + by];
    if (next !== undefined && !this.list.disabled) this.ask(next);
  }
}
