// The live view in Chromium: loads the page, uses it as a person does, and prints what it found as JSON.
//   browser.mjs NODE_MODULES CHROMIUM URL SENSOR PICTURE
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

const [modules, executablePath, url, sensor, picture] = process.argv.slice(2);
const require = createRequire(`${modules}/x.js`);
const { chromium } = require("playwright-core");
const origin = new URL(url).origin;
const timeout = 120_000; // a loaded machine draws slowly

const browser = await chromium.launch({
  executablePath, args: ["--no-sandbox", "--enable-unsafe-swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 1024, height: 700 } });
page.setDefaultTimeout(timeout);
const found = { errors: [], foreign: [] };
page.on("console", (m) => { if (m.type() === "error") found.errors.push(m.text()); });
page.on("pageerror", (e) => found.errors.push(String(e)));
page.on("request", (r) => { if (!r.url().startsWith(origin) && !/^(blob|data|ws):/.test(r.url())) found.foreign.push(r.url()); });

const until = (condition, argument) => page.waitForFunction(condition, argument, { timeout, polling: 50 });
try {
  await page.goto(url, { waitUntil: "domcontentloaded" });
  await until(() => window.dmise?.objects() > 0 && window.dmise.pictures() > 1);
  found.objects = await page.evaluate(() => dmise.objects());
  found.nodes = await page.locator("#health tbody tr").count();

  // A click on the sensor shows its last frame.
  await until((name) => [...document.querySelectorAll("#sensor option")].some((o) => o.value === name), sensor);
  await until((name) => dmise.screen_of(name), sensor);
  const box = await page.locator("#globe .objects").boundingBox();
  const at = await page.evaluate((name) => dmise.screen_of(name), sensor);
  const clicked = Date.now();
  await page.mouse.click(box.x + at.x, box.y + at.y);
  await until((name) => document.getElementById("sensor").value === name &&
    document.getElementById("frame").dataset.shown?.startsWith(`/frames/${name}/`), sensor);
  found.click_ms = Date.now() - clicked;
  found.lit = await page.evaluate(() => {
    const canvas = document.getElementById("frame");
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((v, i) => i % 4 !== 3 && v > 0);
  });

  // Faster: the clock says so.
  await page.locator("#speed").selectOption("50");
  await until(() => dmise.pace() === 50 && document.getElementById("speed").value === "50");
  found.pace = await page.evaluate(() => dmise.pace());

  // Truth is shown to whoever may see it, of a frame in which there is something.
  found.shows_truth = await page.locator("#truth").isVisible();
  if (found.shows_truth) {
    await page.locator("#truth").check();
    [found.frame, found.truths] = await (await until((name) => {
      const truths = Number(document.getElementById("frame").dataset.truths);
      return truths > 0 && [dmise.frame(name), truths];
    }, sensor)).jsonValue();
    await page.locator("#truth").blur(); // where a space would be its own
  }

  // Pausing stops the simulation's time: by the keyboard.
  await page.locator("body").press(" ");
  await until(() => document.getElementById("phase").textContent === "paused");
  const after_statuses = (n) => until((least) => dmise.statuses() >= least, n);
  await after_statuses((await page.evaluate(() => dmise.statuses())) + 3); // what was granted is done
  found.paused_s = await page.evaluate(() => dmise.time_s());
  await after_statuses((await page.evaluate(() => dmise.statuses())) + 4);
  found.later_s = await page.evaluate(() => dmise.time_s());

  // What is kept of the past.
  await page.locator("#past").focus();
  await page.keyboard.press("Home");
  await until((present) => dmise.time_s() < present, found.later_s);
  found.past_s = await page.evaluate(() => dmise.time_s());
  await page.screenshot({ path: picture });
  await page.locator("#live").click();
  await until((present) => dmise.time_s() >= present, found.later_s);

  await page.evaluate(readFileSync(require.resolve("axe-core/axe.min.js"), "utf8"));
  const audit = await page.evaluate(() => axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] }));
  found.violations = audit.violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(" ")).join(", ")}`);
  found.checked = audit.passes.length;

  await page.locator("#pause").click(); // goes on
  await until((present) => dmise.time_s() > present, found.later_s);
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));
