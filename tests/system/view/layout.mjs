// How the live view looks, of a run that is made here: eight sites, of which some are neighbours, and a dark preview. Prints JSON:
// names on the globe and how many of them meet, the median of the frame's picture, and what a phone shows of it.
//   layout.mjs NODE_MODULES CHROMIUM DASHBOARD PREVIEW PICTURES
import { createRequire } from "node:module";
import { createServer } from "node:http";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const [modules, executablePath, dashboard, preview, pictures] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/x.js`)("playwright-core");
const types = { html: "text/html", js: "text/javascript", css: "text/css", json: "application/json", jpg: "image/jpeg", xml: "application/xml", png: "image/png" };
const server = createServer((request, answer) => {
  const path = request.url === "/" ? "/index.html" : request.url.split("?")[0];
  try {
    const content = readFileSync(path.startsWith("/frames/") ? preview : join(dashboard, path));
    answer.writeHead(200, { "Content-Type": types[path.split(".").pop()] ?? "application/octet-stream" }).end(content);
  } catch {
    answer.writeHead(404).end();
  }
}).listen(0, "127.0.0.1");
await new Promise((ready) => server.on("listening", ready));

/** Runs in the page: a gateway that is not there. */
function pretend() {
  const sites = [["atlanta", 33.75, -84.4], ["atlanta-east", 33.8, -84.0], ["huntsville", 34.7, -86.6], ["savannah", 32.1, -81.1],
    ["mcdonald", 30.7, -104.0], ["mcdonald-wide", 30.7, -104.0], ["la-palma", 28.8, -17.9], ["cerro-tololo", -30.2, -70.8]];
  window.WebSocket = class {
    static OPEN = 1;
    readyState = 1;
    constructor() { setTimeout(() => this.begin()); }
    send() {}
    tell(message) { this.onmessage({ data: JSON.stringify(message) }); }
    begin() {
      this.onopen();
      this.tell({ type: "welcome", may_control: true, sees_truth: true });
      this.tell({ type: "run", start_utc: "2018-01-21T00:15:00Z", start_utc_ms: 1516493700000, tick_s: 1, last_tick: 100 });
      this.tell({
        type: "status", run_id: "1", phase: "running", paused: false, pace: 10, cause: "", settled_tick: 50, granted_tick: 51, last_tick: 100, time_s: 50,
        rate: 10, ticks_per_s: 10, overruns: 3, worst_lag_s: 0.25, missing: [], holding: ["huntsville"], past: { from_s: 0, to_s: 50, states: 50 },
        nodes: sites.map(([name]) => ({ name, state: name === "huntsville" ? "awaited" : "alive", tick: 50, start: 1, lag_ticks: 0, ticks_per_s: 10, compute_s: 5, message_s: 0, wait_s: 0, frames: 5, detections: 9, peak_resident_bytes: 1e8, gaps: 0 })),
      });
      const direction = (lat, lon) => {
        const a = (lat * Math.PI) / 180, b = (lon * Math.PI) / 180;
        return [Math.cos(a) * Math.cos(b), Math.cos(a) * Math.sin(b), Math.sin(a)];
      };
      this.tell({
        type: "sensors", sensors: sites.map(([name, lat, lon]) => ({
          name, frame: 5, start_s: 48, end_s: 50, columns: 640, rows: 480, ra_rad: 0, dec_rad: 0, scale_rad: 1e-4, limiting_magnitude: 12, background_e: 1, noise_e: 1,
          stars_expected: 0, stars_found: 0, objects_rendered: 0, detections: 3, detection_off: false, detections_total: 9,
          position_km: direction(lat, lon).map((x) => 6371 * x), boresight: direction(lat, lon),
          field: Array.from({ length: 24 }, (_, k) => direction(lat + 4 * Math.cos(k * 0.26), lon + 4 * Math.sin(k * 0.26))).flat(),
        })),
      });
    }
  };
}

const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
page.setDefaultTimeout(120_000);
await page.addInitScript(pretend);
const found = { errors: [] };
page.on("pageerror", (e) => found.errors.push(String(e)));
try {
  await page.goto(`http://127.0.0.1:${server.address().port}/`, { waitUntil: "domcontentloaded" });
  await page.waitForFunction(() => window.dmise?.named().length > 4 && document.getElementById("frame").dataset.shown, null, { polling: 100 });
  const names = await page.evaluate(() => dmise.named());
  const meet = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  found.names = names.length;
  found.meeting = names.filter((a, i) => names.some((b, k) => k < i && meet(a, b))).length;
  found.median = await page.evaluate(() => {
    const canvas = document.getElementById("frame");
    const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
    return [...data].filter((_, i) => i % 4 === 0).sort((a, b) => a - b)[data.length / 8];
  });
  await page.screenshot({ path: join(pictures, "live-1280.png") });

  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(500);
  found.phone = await page.evaluate(() => {
    const frame = document.getElementById("frame");
    frame.scrollIntoView({ block: "center" });
    const box = frame.getBoundingClientRect(), x = box.left + box.width / 2;
    let seen = 0; // pixels of the frame's height that nothing covers
    for (let y = 0; y < innerHeight; ++y) seen += document.elementFromPoint(x, y) === frame;
    return { frame_px: Math.round(box.height), seen_px: seen, wide_px: document.documentElement.scrollWidth };
  });
  await page.screenshot({ path: join(pictures, "live-390.png") });
} finally {
  await browser.close();
  server.close();
}
console.log(JSON.stringify(found));
