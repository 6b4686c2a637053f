// All objects as points on a canvas above the globe, projected by the page itself. The globe does not turn beneath the camera, so
// that a new picture of the objects needs no new picture of the globe: without a graphics processor that is a tenth of the work.
import * as Cesium from "@cesium/engine";
import { Horizon } from "./horizon";

const longest_step_s = 600; // beyond it, a straight line is no path

export class ObjectCloud {
  private readonly canvas = document.createElement("canvas");
  private readonly context = this.canvas.getContext("2d")!;
  private readonly colour: number; // as the canvas stores it
  private image = new ImageData(1, 1);
  private pixels = new Uint32Array(this.image.data.buffer);
  private before: Float32Array = new Float32Array();
  private after: Float32Array = new Float32Array();
  private time_s = 0;
  private arrived_ms = 0;
  private spacing_ms = 100;
  private jump = true;
  private dirty = false;
  private readonly screen_from_km = new Cesium.Matrix4();

  constructor(private readonly container: Element, colour: string) {
    this.canvas.setAttribute("aria-hidden", "true");
    this.canvas.className = "objects";
    container.append(this.canvas);
    const bytes = Cesium.Color.fromCssColorString(colour).toBytes();
    this.colour = new Uint32Array(new Uint8Array(bytes).buffer)[0]!;
  }

  get count(): number { return this.after.length / 3; }

  set(position_km: Float32Array, time_s: number): void {
    const now = performance.now();
    const same = position_km.length === this.after.length && time_s > this.time_s && time_s - this.time_s < longest_step_s;
    this.before = same ? this.shown() : position_km;
    this.spacing_ms = Math.min(2000, Math.max(50, now - this.arrived_ms));
    this.jump = !same;
    this.arrived_ms = now;
    this.after = position_km;
    this.time_s = time_s;
    this.dirty = true;
  }

  private part(): number {
    return this.jump ? 1 : Math.min(1, (performance.now() - this.arrived_ms) / this.spacing_ms);
  }

  /** Positions as they are on the screen now [km]. */
  shown(): Float32Array {
    const part = this.part();
    if (part >= 1) return this.after;
    const shown = new Float32Array(this.after.length);
    for (let i = 0; i < shown.length; ++i) shown[i] = this.before[i]! + part * (this.after[i]! - this.before[i]!);
    return shown;
  }

  get moves(): boolean { return this.part() < 1 || this.dirty; }

  /** Draws the objects as the camera sees them now. */
  draw(camera: Cesium.Camera): void {
    this.dirty = false;
    const { clientWidth: columns, clientHeight: rows } = this.container;
    if (columns < 2 || rows < 2) return;
    if (this.image.width !== columns || this.image.height !== rows) {
      [this.canvas.width, this.canvas.height] = [columns, rows];
      this.image = new ImageData(columns, rows);
      this.pixels = new Uint32Array(this.image.data.buffer);
    }
    this.pixels.fill(0);
    this.project(camera, columns, rows);
    this.context.putImageData(this.image, 0, 0);
  }

  private project(camera: Cesium.Camera, columns: number, rows: number): void {
    const { before, after, pixels, colour } = this;
    const part = this.part();
    const m = Cesium.Matrix4.multiply(camera.frustum.projectionMatrix, camera.viewMatrix, this.screen_from_km);
    const horizon = new Horizon(camera.positionWC);
    for (let i = 0; i + 2 < after.length; i += 3) {
      const ax = after[i]!, ay = after[i + 1]!, az = after[i + 2]!;
      if (ax === 0 && ay === 0 && az === 0) continue; // without a state
      const x = 1e3 * (before[i]! + part * (ax - before[i]!));
      const y = 1e3 * (before[i + 1]! + part * (ay - before[i + 1]!));
      const z = 1e3 * (before[i + 2]! + part * (az - before[i + 2]!));
      const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
      if (w <= 0) continue; // behind the camera
      const column = Math.floor((0.5 + (0.5 * (m[0]! * x + m[4]! * y + m[8]! * z + m[12]!)) / w) * columns);
      const row = Math.floor((0.5 - (0.5 * (m[1]! * x + m[5]! * y + m[9]! * z + m[13]!)) / w) * rows);
      if (column < 0 || row < 0 || column > columns - 2 || row > rows - 2) continue;
      if (horizon.hides(x, y, z)) continue;
      const at = row * columns + column;
      pixels[at] = pixels[at + 1] = pixels[at + columns] = pixels[at + columns + 1] = colour;
    }
  }
}
