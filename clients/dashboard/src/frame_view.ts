// The last frame of a sensor with its detections.
import type { Detection, Sensor, Truth } from "./messages";
import { palette } from "./palette";

const deg = 180 / Math.PI;

export class FrameView {
  private image: HTMLImageElement | null = null;
  private readonly stretched = document.createElement("canvas"); // the image by `stretch`
  private stretch = 1;
  private loading = "";
  private failed = "";
  private shown = "";
  private sensor: Sensor | null = null;
  private detections: Detection[] = [];
  private truths: Truth[] = [];

  constructor(private readonly canvas: HTMLCanvasElement, private readonly note: HTMLElement) {
    canvas.width = 640;
    canvas.height = 400;
    canvas.addEventListener("mousemove", (event) => this.hover(event));
    canvas.addEventListener("mouseleave", () => this.describe());
  }

  /** `stretch`: 0 as stored, 1 by percentiles, more: brighter. */
  show(sensor: Sensor | undefined, detections: Detection[], truths: Truth[], stretch: number): void {
    if (stretch !== this.stretch) {
      this.stretch = stretch;
      this.make_stretched();
    }
    this.sensor = sensor ?? null;
    this.detections = sensor ? detections.filter((d) => d.sensor === sensor.name && d.frame === sensor.frame) : [];
    this.truths = sensor ? truths.filter((t) => t.sensor === sensor.name && t.frame === sensor.frame) : [];
    this.canvas.dataset.truths = String(this.truths.length);
    if (sensor) this.load(`/frames/${encodeURIComponent(sensor.name)}/${sensor.frame}.png`);
    this.draw();
    this.describe();
  }

  /** One picture is fetched at a time: of many that come meanwhile, the newest is next. */
  private load(url: string): void {
    if (this.loading || url === this.shown || url === this.failed) return;
    this.loading = url;
    const image = new Image();
    const done = (loaded: boolean): void => {
      this.loading = "";
      if (loaded) { this.image = image; this.shown = url; this.make_stretched(); } else { this.failed = url; this.image = null; this.shown = ""; }
      this.canvas.dataset.shown = this.shown;
      this.draw();
      this.describe();
      if (this.sensor) this.load(`/frames/${encodeURIComponent(this.sensor.name)}/${this.sensor.frame}.png`);
    };
    image.onload = () => done(true);
    image.onerror = () => done(false);
    image.src = url;
  }

  /** The preview's sky and its noise are dark, to leave room for bright stars: shows from the 1 % quantile of its pixels to the
   * 99.8 %, and at least six times what lies between the 1 % quantile and the median. */
  private make_stretched(): void {
    const { image, stretched } = this;
    if (!image) return;
    stretched.width = image.naturalWidth;
    stretched.height = image.naturalHeight;
    const context = stretched.getContext("2d", { willReadFrequently: true })!;
    context.drawImage(image, 0, 0);
    if (this.stretch === 0) return;
    const pixels = context.getImageData(0, 0, stretched.width, stretched.height), data = pixels.data;
    const counts = new Uint32Array(256);
    for (let i = 0; i < data.length; i += 4) ++counts[data[i]!]!;
    const quantile = (share: number): number => {
      let value = 0, below = counts[0]!;
      while (value < 255 && below < share * (data.length / 4)) below += counts[++value]!;
      return value;
    };
    const low = quantile(0.01), high = Math.max(quantile(0.998), low + 6 * (quantile(0.5) - low), low + 16);
    const shown = Uint8Array.from({ length: 256 }, (_, v) => 255 * Math.min(1, Math.max(0, (this.stretch * (v - low)) / (high - low))) ** 0.7);
    for (let i = 0; i < data.length; i += 4) data[i] = data[i + 1] = data[i + 2] = shown[data[i]!]!;
    context.putImageData(pixels, 0, 0);
  }

  private scale(): number { return this.sensor ? this.canvas.width / this.sensor.columns : 1; }

  private draw(): void {
    const { canvas, sensor, image } = this;
    const context = canvas.getContext("2d")!;
    if (sensor) {
      const height = Math.round((canvas.width * sensor.rows) / Math.max(1, sensor.columns));
      if (canvas.height !== height) canvas.height = height;
    }
    context.fillStyle = "#000";
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!sensor) return;
    const current = this.shown === `/frames/${encodeURIComponent(sensor.name)}/${sensor.frame}.png`;
    const same_sensor = this.shown.startsWith(`/frames/${encodeURIComponent(sensor.name)}/`);
    if (image && same_sensor) context.drawImage(this.stretched, 0, 0, canvas.width, canvas.height);
    if (!current && this.image) return; // the marks are of a picture that is on its way
    const scale = this.scale();
    this.draw_truth(context, scale);
    context.strokeStyle = palette.detection;
    context.fillStyle = palette.detection;
    context.lineWidth = 1.5;
    context.font = "12px sans-serif";
    for (const d of this.detections) {
      const [x1, y1, x2, y2] = d.kind === "streak" ? d.ends_px : [d.x_px, d.y_px, d.x_px, d.y_px];
      const left = (Math.min(x1, x2) + 0.5) * scale - 7, top = (Math.min(y1, y2) + 0.5) * scale - 7;
      context.strokeRect(left, top, Math.abs(x2 - x1) * scale + 14, Math.abs(y2 - y1) * scale + 14);
      if (this.detections.length <= 20) context.fillText(d.magnitude.toFixed(1), left, top - 3);
    }
  }

  /** Trails dashed, with a ring at mid exposure: another shape than the boxes of detections. */
  private draw_truth(context: CanvasRenderingContext2D, scale: number): void {
    context.strokeStyle = context.fillStyle = palette.truth;
    context.lineWidth = 1.5;
    context.font = "12px sans-serif";
    for (const t of this.truths) {
      const [x0, y0, x1, y1, x2, y2] = t.path_px.map((v) => (v + 0.5) * scale) as Truth["path_px"];
      context.setLineDash([4, 4]);
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.lineTo(x2, y2);
      context.stroke();
      context.setLineDash([]);
      context.beginPath();
      context.arc(x1, y1, 5, 0, 2 * Math.PI);
      context.stroke();
      if (this.truths.length <= 20) context.fillText(`${t.name || t.number} ${t.magnitude.toFixed(1)}`, x1 + 8, y1 + 14);
    }
  }

  private describe(): void {
    const { sensor } = this;
    if (!sensor) { this.note.textContent = "No frame yet."; return; }
    const found = sensor.shutter_closed ? "the shutter is closed" : sensor.detection_off ? "detection is off" : `${sensor.detections} detection${sensor.detections === 1 ? "" : "s"}, limit V ${sensor.limiting_magnitude.toFixed(1)}`;
    const missing = this.failed.endsWith(`/${sensor.frame}.png`) ? " Its sensor does not serve it any more (--products DIRECTORY has previews of all, with output: {png: true})." : "";
    const truth = this.truths.length ? ` ${this.truths.length} object${this.truths.length === 1 ? "" : "s"} in truth.` : "";
    this.note.textContent = `${sensor.name}, frame ${sensor.frame}, RA ${(sensor.ra_rad * deg).toFixed(2)} Dec ${(sensor.dec_rad * deg).toFixed(2)}, ${found}.${truth}${missing}`;
  }

  private hover(event: MouseEvent): void {
    const box = this.canvas.getBoundingClientRect();
    const to_px = (this.canvas.width / box.width) / this.scale();
    const x = (event.clientX - box.left) * to_px - 0.5, y = (event.clientY - box.top) * to_px - 0.5;
    let best: Detection | null = null, least = 12 * to_px;
    for (const d of this.detections) {
      const off = Math.hypot(d.x_px - x, d.y_px - y);
      if (off < least) [least, best] = [off, d];
    }
    if (!best) return this.describe();
    this.note.textContent = `${best.id}: ${best.kind}, ${best.magnitude.toFixed(2)} mag, SNR ${best.snr.toFixed(1)}, RA ${(best.ra_rad * deg).toFixed(4)} Dec ${(best.dec_rad * deg).toFixed(4)}`;
  }
}
