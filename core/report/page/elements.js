// The page of a run draws what the JSON of the element #run says. Texts of a run become text nodes, never markup.
// The files of this directory are one script, in the order of embed_resources.cmake.

const run = JSON.parse(document.getElementById("run").textContent);
const page = document.getElementById("page");

function put(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  for (const child of children.flat())
    if (child !== undefined && child !== null && child !== false) node.append(child);
  return node;
}
const html = (tag, attributes, ...children) => put(document.createElement(tag), attributes, children);
const svg = (tag, attributes, ...children) =>
  put(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

/** A link to a file beside the page; every part of its path is escaped. */
function link(path, text) {
  return html("a", {href: path.split("/").map(encodeURIComponent).join("/")}, text || path);
}

const isNumber = (value) => typeof value === "number" && Number.isFinite(value);
function fixed(value, digits, unit = "") {
  return isNumber(value) ? value.toFixed(digits) + unit : "–";
}
const counted = (value, thing) => `${whole(value)} ${thing}${value === 1 ? "" : "s"}`;
const whole = (value) => isNumber(value) ? Math.round(value).toLocaleString("en") : "–";
function seconds(value) {
  if (!isNumber(value)) return "–";
  return value >= 100 ? value.toFixed(0) + " s" : value >= 0.1 ? value.toFixed(2) + " s" : (1000 * value).toFixed(2) + " ms";
}

function table(caption, columns, rows) {
  const head = html("tr", {}, columns.map((c) => html("th", {scope: "col", class: c.name ? "name" : null}, c.title)));
  const body = rows.map((row) => html("tr", {}, row.map((cell, k) =>
    html("td", {class: columns[k].why ? "why" : columns[k].name ? "name" : null, "data-title": columns[k].title}, cell ?? "–"))));
  return html("div", {class: columns.length > 4 ? "scroll wide" : "scroll", tabindex: "0", role: "region", "aria-label": caption},
    html("table", {}, html("caption", {}, caption), html("thead", {}, head), html("tbody", {}, body)));
}

function section(id, title, ...children) {
  page.append(html("section", {id, "aria-labelledby": id + "-title"}, html("h2", {id: id + "-title"}, title), ...children));
  sections.push([id, title]);
}
const sections = [];
