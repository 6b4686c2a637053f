// Charts of what has come since the page was opened.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { palette } from "./palette";

const most_points = 600;

export class Chart {
  private readonly plot: uPlot;
  private readonly x: number[] = [];
  private readonly y: number[] = [];
  private drawn_ms = 0;

  constructor(container: HTMLElement, title: string, x_label: string, points: boolean) {
    const axis = { stroke: palette.text, grid: { stroke: "#2a3442" }, ticks: { stroke: "#2a3442" }, font: "11px sans-serif" };
    this.plot = new uPlot({
      width: 400, height: 130, title, legend: { show: false }, cursor: { show: false }, scales: { x: { time: false }, y: { range: (_u, _low, high) => [0, Math.max(1, 1.1 * high)] } },
      axes: [{ ...axis, label: x_label, labelSize: 16, labelFont: "11px sans-serif", size: 30 }, { ...axis, size: 46 }],
      series: [{}, { stroke: points ? palette.detection : palette.alive, width: points ? 0 : 1.5, points: { show: points, size: 5, fill: palette.detection } }],
    }, [[], []], container);
    new ResizeObserver(() => this.plot.setSize({ width: Math.max(100, container.clientWidth), height: 130 })).observe(container);
  }

  add(x: number, y: number): void {
    this.x.push(x);
    this.y.push(y);
    if (this.x.length > most_points) { this.x.shift(); this.y.shift(); }
    const now = performance.now();
    if (now - this.drawn_ms < 500) return;
    this.drawn_ms = now;
    this.plot.setData([this.x, this.y]);
  }
}
