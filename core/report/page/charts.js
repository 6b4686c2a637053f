// Charts of lines and points over two axes, and plots of the sky.

/** Values with a label: three or more, of round numbers. */
function ticksOf(least, most, log) {
  if (log) {
    const decades = Math.log10(most / least);
    for (const digits of [[1], [1, 2, 5], [1, 2, 3, 5, 7]]) {
      const ticks = [];
      for (let e = Math.floor(Math.log10(least)); e <= Math.ceil(Math.log10(most)); ++e)
        for (const m of digits) if (m * 10 ** e >= least * 0.999 && m * 10 ** e <= most * 1.001) ticks.push(m * 10 ** e);
      if (ticks.length >= (decades > 3 ? 3 : 4)) return ticks;
    }
  }
  let ticks = [];
  for (let parts = 6; ticks.length < 3 && parts < 100; parts *= 1.5) {
    const raw = (most - least) / parts, power = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].find((m) => m * power >= raw * 0.999) * power;
    ticks = [];
    for (let k = Math.ceil(least / step - 1e-9); k * step <= most + step * 1e-9; ++k) ticks.push(k * step);
  }
  return ticks;
}
const short = (v) => {
  const size = Math.abs(v);
  return size >= 1e4 ? v.toLocaleString("en", {maximumFractionDigits: 0}) : String(Number(v.toPrecision(6)));
};

let charts = 0;
function chart({title, note, x, y, series, bands = [], height = 300}) {
  const wide = page.clientWidth < 600 ? 360 : 560, box = {left: 70, right: 14, top: 10, bottom: 44};
  const points = series.flatMap((s) => s.lines.flat());
  if (!points.length) return null;
  const range = (axis, k) => {
    let values = points.map((p) => p[k]).concat(axis.also || []);
    if (axis.log) values = values.filter((v) => v > 0);
    let least = axis.least ?? values.reduce((a, b) => Math.min(a, b), Infinity);
    let most = axis.most ?? values.reduce((a, b) => Math.max(a, b), -Infinity);
    if (axis.log) return most > least ? [least / 1.15, most * 1.15] : [least / 2, most * 2];
    const room = axis.least === undefined ? (most - least) * 0.05 || Math.abs(most) * 0.05 || 1 : 0;
    return [least - room, most + (axis.most === undefined ? room || (most - least) * 0.05 || 1 : 0)];
  };
  const scaleOf = (axis, k, from, to) => {
    const [least, most] = range(axis, k), f = axis.log ? Math.log : (v) => v;
    const a = f(least), b = f(most), flip = axis.flip;
    return {least, most, of: (v) => { const u = (f(v) - a) / (b - a); return from + (flip ? 1 - u : u) * (to - from); }};
  };
  const sx = scaleOf(x, 0, box.left, wide - box.right), sy = scaleOf(y, 1, height - box.bottom, box.top);
  const parts = [];
  for (const [from, to] of bands) {
    const a = Math.max(sx.least, from), b = Math.min(sx.most, to);
    if (b > a) parts.push(svg("rect", {class: "band", x: sx.of(a), y: box.top, width: Math.max(1, sx.of(b) - sx.of(a)),
      height: height - box.top - box.bottom}));
  }
  for (const t of ticksOf(sx.least, sx.most, x.log)) {
    parts.push(svg("path", {class: "grid", d: `M${sx.of(t)} ${box.top}V${height - box.bottom}`}));
    parts.push(svg("text", {"data-axis": "x", x: sx.of(t), y: height - box.bottom + 16, "text-anchor": "middle"}, (x.format || short)(t)));
  }
  for (const t of ticksOf(sy.least, sy.most, y.log)) {
    parts.push(svg("path", {class: "grid", d: `M${box.left} ${sy.of(t)}H${wide - box.right}`}));
    parts.push(svg("text", {"data-axis": "y", x: box.left - 6, y: sy.of(t) + 4, "text-anchor": "end"}, short(t)));
  }
  parts.push(svg("rect", {class: "frame", x: box.left, y: box.top, width: wide - box.left - box.right, height: height - box.top - box.bottom}));
  parts.push(svg("text", {class: "dimtext", x: (box.left + wide - box.right) / 2, y: height - 6, "text-anchor": "middle"}, x.label));
  parts.push(svg("text", {class: "dimtext", transform: `translate(12 ${(height - box.bottom + box.top) / 2}) rotate(-90)`, "text-anchor": "middle"}, y.label));
  for (const s of series) {
    const group = svg("g", {class: s.colour, stroke: "currentColor", fill: "currentColor"});
    for (const list of s.lines) {
      const good = list.filter((p) => isNumber(p[0]) && isNumber(p[1]) && (!y.log || p[1] > 0) && (!x.log || p[0] > 0));
      if (s.line !== false && good.length > 1)
        group.append(svg("path", {fill: "none", "stroke-width": s.thin ? 1 : 1.8, "stroke-dasharray": s.dash,
          d: good.map((p, k) => `${k ? "L" : "M"}${sx.of(p[0]).toFixed(1)} ${sy.of(p[1]).toFixed(1)}`).join("")}));
      if (s.mark) for (const p of good) {
        const dot = shape(s.mark, sx.of(p[0]), sy.of(p[1]), s.size || 3.2);
        if (p[2]) dot.append(svg("title", {}, p[2]));
        const from = (v) => (sy.of(v) - sy.of(p[1])).toFixed(1);
        if (p[3]) dot.prepend(svg("path", {class: "interval", "stroke-width": 1, d: `M0 ${from(p[3][0])}V${from(p[3][1])}`}));
        group.append(dot);
      }
    }
    parts.push(group);
  }
  const id = `chart-${++charts}`;
  return html("figure", {}, html("figcaption", {id}, title, note ? html("small", {}, note) : null),
    svg("svg", {viewBox: `0 0 ${wide} ${height}`, role: "img", "aria-labelledby": id}, parts),
    keyOf(series.filter((s) => s.label)));
}
function shape(kind, x, y, r) {
  const at = {transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`};
  const d = {
    circle: `M${-r} 0a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`,
    square: `M${-r} ${-r}h${2 * r}v${2 * r}h${-2 * r}z`,
    triangle: `M0 ${-1.3 * r}L${1.2 * r} ${r}H${-1.2 * r}z`,
    diamond: `M0 ${-1.4 * r}L${1.4 * r} 0L0 ${1.4 * r}L${-1.4 * r} 0z`,
    cross: `M${-r} ${-r}L${r} ${r}M${r} ${-r}L${-r} ${r}`,
    plus: `M${-1.3 * r} 0H${1.3 * r}M0 ${-1.3 * r}V${1.3 * r}`,
  }[kind];
  const open = kind === "cross" || kind === "plus";
  return svg("g", at, svg("path", {d, fill: open ? "none" : "currentColor", stroke: open ? "currentColor" : "none", "stroke-width": 1.6}));
}
const shapes = ["circle", "square", "triangle", "diamond", "cross", "plus"];
function keyOf(series) {
  if (!series.length) return null;
  return html("ul", {class: "key"}, series.map((s) => html("li", {}, svg("svg", {viewBox: "0 0 18 12", class: s.colour, "aria-hidden": "true"},
    s.line !== false ? svg("path", {d: "M0 6H18", stroke: "currentColor", "stroke-width": 1.8, "stroke-dasharray": s.dash}) : null,
    s.mark ? shape(s.mark, 9, 6, 3.6) : null), s.label)));
}
const minutes = (s) => s / 60;
const timeAxis = () => ({label: run.start_utc ? `minutes since ${run.start_utc.replace("T", " ").replace("Z", "")} UTC` : "minutes"});

/** Shows `make(sensor)` for some sensors at a time. */
function bySensor(make, most, what) {
  const able = run.sensors.map((_, k) => k).filter((k) => framesOf[k].length);
  const grid = html("div", {class: "charts"});
  const show = (from) => grid.replaceChildren(...able.slice(from, from + most).map(make).filter((figure) => figure));
  show(0);
  if (able.length <= most) return grid;
  const choice = html("select", {"aria-label": `Sensors of ${what}`, onchange: (event) => show(Number(event.target.value))});
  for (let k = 0; k < able.length; k += most) {
    const end = Math.min(able.length, k + most) - 1;
    choice.append(html("option", {value: k}, `${run.sensors[able[k]].name} to ${run.sensors[able[end]].name}`));
  }
  return html("div", {}, html("p", {}, html("label", {}, "Sensors ", choice)), grid);
}
