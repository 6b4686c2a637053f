// Opens a run's page in Debian's Chromium, offline, and says what it shows: one JSON object on stdout.
//   node page.mjs NODE_PACKAGES PAGE [SCREENSHOTS]     (requests on stdin: {"frame": index, "places": [[x, y], ..]})
import {createRequire} from "node:module";
import {existsSync, readFileSync} from "node:fs";
import {pathToFileURL} from "node:url";

const [packages, page_path, screenshots] = process.argv.slice(2);
const require = createRequire(pathToFileURL(`${packages}/node_modules/`));
const {chromium} = require("playwright-core");
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync);
const wanted = JSON.parse(readFileSync(0, "utf8") || "{}");
const out = {errors: [], requests: [], hover: [], violations: []};
const patience = 240_000;

const browser = await chromium.launch({executablePath, args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]});
try {
  const context = await browser.newContext({viewport: {width: 1280, height: 900}, colorScheme: "dark", bypassCSP: false});
  await context.setOffline(true);
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  page.on("console", (message) => { if (message.type() === "error") out.errors.push(message.text()); });
  page.on("pageerror", (error) => out.errors.push(String(error)));
  page.on("dialog", (dialog) => { out.errors.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) out.requests.push(request.url()); });
  await page.goto(pathToFileURL(page_path).href, {waitUntil: "load"});
  await page.waitForSelector("html[data-ready]");
  out.title = await page.locator("h1").textContent();
  out.sections = await page.locator("section > h2").allTextContents();
  out.thumbnails = await page.locator(".thumb").count();
  out.charts = await page.locator("figure svg[role=img]").count();
  out.links = await page.locator("section#files a").evaluateAll((list) => list.map((a) => a.getAttribute("href")));
  out.images = await page.locator("img").count();
  out.scripts = await page.evaluate(() => document.scripts.length);
  out.injected = await page.evaluate(() => Boolean(window.injected) || document.querySelectorAll("main img[src='x']").length > 0);
  out.text = await page.locator("main").innerText();

  const axe = async () => {
    // As a script of the page its policy refuses it; evaluated by the browser's own protocol it may run.
    await page.evaluate(readFileSync(`${packages}/node_modules/axe-core/axe.min.js`, "utf8") + "; undefined");
    const found = await page.evaluate(() => window.axe.run(document, {resultTypes: ["violations"]}));
    for (const v of found.violations) out.violations.push({id: v.id, what: v.help, where: v.nodes.slice(0, 3).map((n) => n.html.slice(0, 200))});
  };
  if (wanted.axe) {
    await axe();
    await page.emulateMedia({colorScheme: "light"});
    await axe();
    await page.emulateMedia({colorScheme: "dark"});
  }
  if (screenshots) {
    for (let k = 0; k < out.thumbnails; k += 4) await page.locator(".thumb").nth(k).scrollIntoViewIfNeeded();
    await page.waitForTimeout(1500);
    await page.screenshot({path: `${screenshots}/page.png`, fullPage: true});
  }

  if (wanted.widths) {
    // On a screen of its own size, and without scrolling.
    out.widths = [];
    for (const width of wanted.widths) {
      const narrow = await context.newPage();
      narrow.setDefaultTimeout(patience);
      narrow.on("pageerror", (error) => out.errors.push(String(error)));
      await narrow.setViewportSize({width, height: width < 500 ? 844 : 900});
      await narrow.goto(pathToFileURL(page_path).href, {waitUntil: "load"});
      await narrow.waitForSelector("html[data-ready]");
      await narrow.waitForFunction(() => !document.querySelector(".thumb canvas[data-frame]:not([data-drawn])"), null, {timeout: patience});
      out.widths.push(await narrow.evaluate(() => ({
        width: innerWidth,
        page: document.documentElement.scrollWidth,
        tables: [...document.querySelectorAll(".scroll")].filter((t) => t.scrollWidth > t.clientWidth).map((t) => t.ariaLabel),
        cut: [...document.querySelectorAll("#summary td")].filter((c) => c.scrollWidth > c.clientWidth + 1).map((c) => c.textContent),
        labels: [...document.querySelectorAll("figure svg[role=img]")].filter((s) => s.querySelector("[data-axis]"))
          .map((s) => Math.min(...["x", "y"].map((axis) => s.querySelectorAll(`[data-axis=${axis}]`).length))),
        astray: [...document.querySelectorAll(".interval")].filter((bar) => {
          const b = bar.getBoundingClientRect(), d = bar.nextElementSibling.getBoundingClientRect(), y = (d.top + d.bottom) / 2;
          return Math.abs((b.left + b.right - d.left - d.right) / 2) > 1 || y < b.top - 1 || y > b.bottom + 1;
        }).length,
      })));
      if (screenshots) await narrow.screenshot({path: `${screenshots}/page-${width}.png`, fullPage: true});
      await narrow.close();
    }
  }

  if (wanted.places) {
    // By the keyboard: the button of the frame has the focus, Enter opens it.
    await page.locator(`.thumb[data-open="${wanted.frame}"]`).focus();
    await page.keyboard.press("Enter");
    await page.waitForSelector(`dialog[open][data-ready="${wanted.frame}"]`);
    const canvas = page.locator(".stage canvas"), readout = page.locator(".readout");
    const box = await canvas.boundingBox();
    const hover = async ([x, y]) => {
      const [scale, left, top] = await canvas.evaluate((c) => [c.dataset.scale, c.dataset.left, c.dataset.top].map(Number));
      await page.mouse.move(box.x + left + (x + 0.5) * scale, box.y + top + (y + 0.5) * scale);
      out.hover.push(await readout.evaluate((r) => ({...r.dataset, text: r.textContent})));
    };
    for (const place of wanted.places) await hover(place);
    if (screenshots) await page.screenshot({path: `${screenshots}/frame.png`});
    await canvas.focus();
    await page.keyboard.press("Shift+ArrowRight");
    await page.keyboard.press("ArrowDown");
    out.cross = await readout.evaluate((r) => ({...r.dataset, text: r.textContent}));
    const before = await canvas.evaluate((c) => Number(c.dataset.scale));
    await page.keyboard.press("+");
    out.zoomed = (await canvas.evaluate((c) => Number(c.dataset.scale))) / before;
    out.stretches = [];
    for (const name of ["linear", "zscale", "log"]) {
      await page.locator("dialog select").selectOption(name);
      out.stretches.push(await canvas.evaluate((c) => {
        const {data} = c.getContext("2d").getImageData(0, 0, c.width, c.height);
        let sum = 0;
        for (let k = 0; k < data.length; k += 4) sum += data[k];
        return sum / (data.length / 4);
      }));
    }
    if (wanted.axe) await axe();
    await page.keyboard.press("Escape");
    out.closed = await page.locator("dialog[open]").count() === 0;
    out.focus = await page.evaluate(() => document.activeElement?.dataset.open);
  }
} finally {
  await browser.close();
}
process.stdout.write(JSON.stringify(out));
