// Takes a picture of a run's page, or with the ending jpg of its first frame: report.mjs NODE_PACKAGES PAGE PICTURE
import {createRequire} from "node:module";
import {pathToFileURL} from "node:url";

const [packages, page_path, picture] = process.argv.slice(2);
const {chromium} = createRequire(pathToFileURL(`${packages}/node_modules/`))("playwright-core");
const browser = await chromium.launch({executablePath: "/usr/bin/chromium", args: ["--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"]});
const frame = picture.endsWith(".jpg");
const page = await browser.newPage({viewport: {width: 1180, height: frame ? 760 : 900}, colorScheme: "light"});
page.setDefaultTimeout(240_000);
await page.goto(pathToFileURL(page_path).href);
await page.waitForSelector("html[data-ready]");
await page.waitForFunction(() => document.querySelectorAll(".thumb canvas[data-drawn]").length >= 4);
if (frame) {
  await page.locator(".thumb").first().click();
  await page.waitForSelector("dialog[open][data-ready]");
}
await page.screenshot({path: picture, ...(frame ? {type: "jpeg", quality: 82} : {})});
await browser.close();
