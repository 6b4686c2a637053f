// Measures the dashboard: pictures per second with many objects and sensors, drawn in software. What the gateway would send is made
// here, ten states a second. Prints JSON: pictures per second; and, which a loaded machine changes less, processor seconds of all of
// the browser's processes per picture, and per second for what is no picture: states, tables, charts.
//   pictures.mjs NODE_MODULES CHROMIUM DASHBOARD [OBJECTS SENSORS SECONDS WIDTH HEIGHT PICTURE]
import { createRequire } from "node:module";
import { createServer } from "node:http";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

const [modules, executablePath, dashboard, objects = 20000, sensors = 100, seconds = 10, width = 1280, height = 800, picture] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/x.js`)("playwright-core");
const types = { html: "text/html", js: "text/javascript", css: "text/css", json: "application/json", jpg: "image/jpeg", xml: "application/xml", png: "image/png" };
const server = createServer((request, answer) => {
  const path = request.url === "/" ? "/index.html" : request.url.split("?")[0];
  try {
    const content = readFileSync(join(dashboard, path));
    answer.writeHead(200, { "Content-Type": types[path.split(".").pop()] ?? "application/octet-stream" }).end(content);
  } catch {
    answer.writeHead(404).end();
  }
}).listen(0, "127.0.0.1");
await new Promise((ready) => server.on("listening", ready));

/** Runs in the page: a gateway that is not there. */
function pretend({ objects, sensors }) {
  window.WebSocket = class {
    static OPEN = 1;
    readyState = 1;
    constructor() { setTimeout(() => this.begin()); }
    send() {}
    tell(message) { this.onmessage({ data: JSON.stringify(message) }); }
    begin() {
      this.onopen();
      this.tell({ type: "welcome", may_control: true, sees_truth: false });
      this.tell({ type: "run", start_utc: "2018-01-21T00:15:00Z", start_utc_ms: 1516493700000, tick_s: 1, last_tick: 1e6 });
      const orbits = Array.from({ length: objects }, (_, i) => {
        const r = i % 10 === 0 ? 42164 : 6800 + (i % 1200), tilt = (i * 2.399963) % Math.PI, node = (i * 1.324718) % (2 * Math.PI);
        return { r, rate: Math.sqrt(398600.4 / r ** 3), phase: i, c: Math.cos(tilt), s: Math.sin(tilt), cn: Math.cos(node), sn: Math.sin(node) };
      });
      const names = Array.from({ length: sensors }, (_, i) => `sensor-${i}`);
      let t = 0;
      setInterval(() => {
        t += 1;
        const bytes = new ArrayBuffer(24 + 12 * objects), view = new DataView(bytes), xyz = new Float32Array(bytes, 24);
        view.setUint32(0, 0x424f4d44, true);
        view.setUint32(4, objects, true);
        view.setFloat64(8, t, true);
        view.setFloat64(16, 1516493700000 + 1e3 * t, true);
        orbits.forEach((o, i) => {
          const a = o.phase + o.rate * t, x = o.r * Math.cos(a), y = o.r * Math.sin(a);
          xyz.set([x * o.cn - y * o.c * o.sn, x * o.sn + y * o.c * o.cn, y * o.s], 3 * i);
        });
        this.onmessage({ data: bytes });
      }, 100);
      setInterval(() => {
        this.tell({
          type: "status", run_id: "1", phase: "running", paused: false, pace: 10, cause: "", settled_tick: t, granted_tick: t + 1, last_tick: 1e6, time_s: t,
          rate: 10, ticks_per_s: 10, overruns: 0, worst_lag_s: 0, missing: [], holding: [names[t % sensors]], past: { from_s: 0, to_s: t, states: t },
          nodes: names.map((name) => ({ name, state: "alive", tick: t, start: 1, lag_ticks: 0, ticks_per_s: 10, compute_s: t, message_s: 0, wait_s: 0, frames: t, detections: t, peak_resident_bytes: 1e8, gaps: 0 })),
        });
        const direction = (i, k) => {
          const lon = i * 2.4, lat = ((i * 0.37) % 2) - 1, up = [Math.cos(lat) * Math.cos(lon), Math.cos(lat) * Math.sin(lon), Math.sin(lat)];
          const a = (2 * Math.PI * k) / 24, v = [up[0] + 0.3 * Math.cos(a) * -Math.sin(lon), up[1] + 0.3 * Math.cos(a) * Math.cos(lon), up[2] + 0.3 * Math.sin(a)];
          const n = Math.hypot(...v);
          return k < 0 ? up : v.map((x) => x / n);
        };
        this.tell({
          type: "sensors", sensors: names.map((name, i) => ({
            name, frame: t, start_s: t - 2, end_s: t, columns: 640, rows: 480, ra_rad: 0, dec_rad: 0, scale_rad: 1e-4, limiting_magnitude: 12, background_e: 1, noise_e: 1,
            stars_expected: 0, stars_found: 0, objects_rendered: 0, detections: 3, detection_off: false, detections_total: 3 * t,
            position_km: direction(i, -1).map((x) => 6371 * x), boresight: direction(i, -1), field: Array.from({ length: 24 }, (_, k) => direction(i, k)).flat(),
          })),
        });
      }, 500);
    }
  };
}

/** Processor seconds of this process's descendants. */
function cpu_s() {
  const parents = new Map(), used = new Map();
  for (const pid of readdirSync("/proc").filter((n) => /^\d+$/.test(n))) {
    try {
      const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
      parents.set(Number(pid), Number(fields[1]));
      used.set(Number(pid), (Number(fields[11]) + Number(fields[12])) / 100);
    } catch { /* it has ended */ }
  }
  let sum = 0;
  for (const [pid, seconds] of used) {
    let above = pid;
    while (above > 1 && above !== process.pid) above = parents.get(above) ?? 0;
    if (above === process.pid && pid !== process.pid) sum += seconds;
  }
  return sum;
}

const browser = await chromium.launch({
  executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: Number(width), height: Number(height) } });
page.setDefaultTimeout(300_000);
await page.addInitScript(pretend, { objects: Number(objects), sensors: Number(sensors) });
await page.goto(`http://127.0.0.1:${server.address().port}/`, { waitUntil: "domcontentloaded" });
await page.waitForFunction(() => window.dmise?.objects() > 0 && dmise.pictures() > 20 && dmise.statuses() > 4, null, { polling: 200 });
const now = async () => ({ cpu: cpu_s(), ...(await page.evaluate(() => ({ pictures: dmise.pictures(), at: performance.now() }))) });
await page.waitForTimeout(15e3); // the page finds how many pixels it can draw
await page.evaluate(() => dmise.draw(false));
const still = await now();
await page.waitForTimeout(1e3 * Number(seconds));
const between = await now();
await page.evaluate(() => dmise.draw(true));
await page.waitForTimeout(1e3 * Number(seconds));
const end = await now();

if (picture) await page.screenshot({ path: picture });
const pictures = end.pictures - between.pictures, drawn_s = (end.at - between.at) / 1e3;
const cpu_s_per_s = (between.cpu - still.cpu) / ((between.at - still.at) / 1e3);
console.log(JSON.stringify({
  objects: Number(objects), sensors: Number(sensors), pictures_per_s: pictures / drawn_s, cpu_s_per_s,
  cpu_s_per_picture: (end.cpu - between.cpu - cpu_s_per_s * drawn_s) / pictures,
}));
await browser.close();
server.close();
