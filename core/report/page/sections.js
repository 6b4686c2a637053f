// The sections of the page.

function header() {
  const facts = [["Status", run.status + (run.how ? ` (${run.how})` : "")], ["Start", run.start_utc], ["Duration", seconds(run.duration_s)],
    ["Tick", seconds(run.tick_s)], ["Seed", run.seed], ["Wall time", seconds(run.wall_s) + (run.parts > 1 ? ` in ${run.parts} parts` : "")], ["Frames", whole(run.frame_count)],
    ["Software", run.software], ["Digest", run.digest]];
  page.querySelector("h1").textContent = `DMISE run: ${counted(run.sensors.length, "sensor")}`;
  page.append(html("dl", {class: "facts"}, facts.filter(([, value]) => value !== "" && value !== undefined).map(([name, value]) =>
    html("div", {}, html("dt", {}, name), html("dd", {}, String(value))))));
  if (run.status !== "complete")
    page.append(html("p", {class: "bad"}, run.status === "begun" || run.status === "unknown"
      ? "This run has not ended: the page shows what its sensors had written."
      : `This run did not complete (${run.status})${run.reason ? ": " + run.reason : ""}.`));
}

function placeText(sensor) {
  if (sensor.site) {
    const [latitude, longitude, height] = sensor.site;
    return `${fixed(Math.abs(latitude), 3)}° ${latitude < 0 ? "S" : "N"}, ${fixed(Math.abs(longitude), 3)}° ${longitude < 0 ? "W" : "E"}, ${whole(height)} m`;
  }
  return sensor.platform ? `aboard ${sensor.platform}` : "–";
}

function summary() {
  const columns = [{title: "sensor", name: true}, {title: "camera", name: true}, {title: "place", name: true}, {title: "frames"}, {title: "detections"}];
  if (run.has_truth) columns.push({title: "found"}, {title: "missed"}, {title: "too faint"}, {title: "false alarms"}, {title: "Pd"});
  columns.push({title: "limiting magnitude V"}, {title: "s per frame"}, {title: "memory, MB"}, {title: "log", name: true});
  section("summary", "Summary", table("Sensors; Pd is the share of objects expected above SNR 6 that were found", columns, run.sensors.map((s, k) => {
    const row = [html("a", {href: `#sensor-${k}`}, s.name), s.camera || "–", placeText(s), whole(s.frames), whole(s.detections)];
    if (run.has_truth) row.push(whole(s.fates?.found), whole(s.fates?.missed), whole(s.fates?.faint), whole(s.false_alarms), fixed(s.pd, 3));
    row.push(fixed(s.limiting_magnitude, 2), fixed(s.seconds_per_frame, 2), whole(s.memory_mb), s.log ? link(s.log, "log") : "–");
    return row;
  })));
}

function frames() {
  const parts = [html("p", {}, "A click opens the full frame, with stretch, zoom and the direction of each pixel."),
    html("div", {class: "legend"}, Object.entries(mark).map(([kind, m]) => html("span", {}, symbol(kind), m.label)))];
  if (run.every > 1) parts.push(html("p", {class: "dim"}, `Every ${run.every}th frame is in this page; the directories of the sensors have all.`));
  if (run.source_every > 1) parts.push(html("p", {class: "dim"}, `Truth and detections of every ${run.source_every}th of these are marked; the files have all.`));
  run.sensors.forEach((s, k) => parts.push(html("h3", {id: `sensor-${k}`}, s.name), framesOf[k].length
    ? html("div", {}, html("p", {class: "dim"}, `${counted(s.frames, "frame")} in `, link(s.name + "/", s.name + "/")), thumbnails(k))
    : html("p", {class: "dim"}, "no frames")));
  section("frames", "Frames", ...parts);
}

const fateStyle = {found: ["f-found", "circle"], missed: ["f-missed", "cross"], faint: ["f-faint", "plus"]};

/** Passes of a sensor: truth of each object by time, in pieces without gaps. */
function passesOf(sensor) {
  const objects = new Map();
  for (const f of framesOf[sensor])
    for (const t of truthsOf[f]) if (fateStyle[t.fate]) {
      if (!objects.has(t.object)) objects.set(t.object, []);
      objects.get(t.object).push(t);
    }
  const gap = Math.max(1, run.every * run.source_every) * 2.5 * (run.sensors[sensor].cadence_s || 60);
  const passes = [];
  for (const list of objects.values()) {
    list.sort((a, b) => run.frames[a.frame].time_s - run.frames[b.frame].time_s);
    let pass = [];
    for (const t of list) {
      if (pass.length && run.frames[t.frame].time_s - run.frames[pass[pass.length - 1].frame].time_s > gap) { passes.push(pass); pass = []; }
      pass.push(t);
    }
    passes.push(pass);
  }
  return passes;
}
const words = (t) => `${t.object}, ${t.fate}, V ${fixed(t.magnitude, 1)}, expected SNR ${fixed(t.snr, 1)}, ${whole(t.range)} km, ${nameOf(t.frame)}`;

function skyPlot(sensor) {
  const s = run.sensors[sensor], onGround = Boolean(s.site), size = 400, wide = onGround ? 400 : 560, middle = 200, radius = 172;
  const place = onGround
    ? (azimuth, elevation) => {
        const r = radius * (90 - elevation) / 90, a = azimuth * Math.PI / 180;
        return [middle - r * Math.sin(a), middle - r * Math.cos(a)];
      }
    : (ra, dec) => [40 + (360 - ra) / 360 * 500, 40 + (90 - dec) / 180 * 320];
  const parts = [];
  if (onGround) {
    for (const elevation of [0, 30, 60]) {
      parts.push(svg("circle", {class: "grid", cx: middle, cy: middle, r: radius * (90 - elevation) / 90}));
      if (elevation) parts.push(svg("text", {class: "dimtext", x: middle + 3, y: middle - radius * (90 - elevation) / 90 + 13}, `${elevation}°`));
    }
    for (const [text, azimuth] of [["N", 0], ["E", 90], ["S", 180], ["W", 270]]) {
      const [x, y] = place(azimuth, -7);
      parts.push(svg("text", {x, y: y + 4, "text-anchor": "middle"}, text));
    }
    parts.push(svg("path", {class: "grid", d: `M${middle} ${middle - radius}V${middle + radius}M${middle - radius} ${middle}H${middle + radius}`}));
  } else {
    for (let ra = 0; ra <= 360; ra += 60) {
      const [x] = place(ra, 0);
      parts.push(svg("path", {class: "grid", d: `M${x} 40V360`}), svg("text", {class: "dimtext", x, y: 376, "text-anchor": "middle"}, `${ra}°`));
    }
    for (let dec = -90; dec <= 90; dec += 30) {
      const [, y] = place(0, dec);
      parts.push(svg("path", {class: "grid", d: `M40 ${y}H540`}), svg("text", {class: "dimtext", x: 34, y: y + 4, "text-anchor": "end"}, `${dec}°`));
    }
  }
  const joined = (list, closed) => {
    let d = "", before = null;
    for (const [a, b] of closed ? [...list, list[0]] : list) {
      const [x, y] = place(a, b);
      d += `${before === null || (!onGround && Math.abs(a - before) > 180) ? "M" : "L"}${x.toFixed(1)} ${y.toFixed(1)}`;
      before = a;
    }
    return d;
  };
  const outlines = framesOf[sensor].map((f) => run.frames[f].view).filter((v) => v !== undefined && run.views[v].outline?.length > 2);
  const every = Math.max(1, Math.ceil(outlines.length / 12));
  outlines.filter((_, k) => k % every === 0).forEach((v) =>
    parts.push(svg("path", {class: "c0", stroke: "currentColor", fill: "none", "stroke-width": 1.5, d: joined(run.views[v].outline, true)})));
  if (!outlines.length || s.cadence_s && outlines.length > 1) {
    const seen = new Set();
    for (const f of framesOf[sensor]) {
      const at = run.frames[f].pointing, key = at.map((v) => v.toFixed(1)).join();
      if (seen.has(key) || seen.size > 500) continue;
      seen.add(key);
      const [x, y] = place(...at);
      parts.push(put(shape("plus", x, y, 3), {class: "c0"}, [svg("title", {}, `${nameOf(f)} points here`)]));
    }
  }
  let shown = 0;
  for (const pass of passesOf(sensor).slice(0, 800)) {
    if (pass.length > 1) parts.push(svg("path", {class: "grid", d: joined(pass.map((t) => [t.angle, t.height]), false)}));
    for (const t of pass) {
      if (++shown > 3000) break;
      const [x, y] = place(t.angle, t.height), [colour, form] = fateStyle[t.fate];
      parts.push(put(shape(form, x, y, 2.8), {class: colour}, [svg("title", {}, words(t))]));
    }
  }
  const id = `chart-${++charts}`;
  return html("figure", {}, html("figcaption", {id}, s.name, html("small", {}, onGround
    ? "azimuth and elevation, as one looks up: east is left" : "right ascension and declination")),
    svg("svg", {viewBox: `0 0 ${wide} ${size}`, role: "img", "aria-labelledby": id}, parts));
}

const fateKey = () => keyOf([{label: "field of view, pointing", colour: "c0", mark: "plus", line: true},
  ...Object.entries(fateStyle).map(([fate, [colour, mark]]) => ({label: fate, colour, mark, line: false}))]);

function skies() {
  section("sky", "Pointings and passes", html("p", {}, "Fields of view, and where objects with light in a frame were at mid exposure."),
    fateKey(), bySensor(skyPlot, 6, "the sky"));
}

function ranges() {
  if (!run.has_truth) return;
  section("range", "Range against time", html("p", {}, "Distance of the objects in each sensor's frames; a line joins the frames of a pass."),
    bySensor((sensor) => {
      const passes = passesOf(sensor), point = (t) => [minutes(run.frames[t.frame].time_s), t.range, words(t)];
      const series = [{colour: "f-faint", thin: true, lines: passes.filter((p) => p.length > 1).map((p) => p.map(point))}];
      for (const [fate, [colour, form]] of Object.entries(fateStyle)) {
        const list = passes.flat().filter((t) => t.fate === fate).slice(0, 3000);
        if (list.length) series.push({label: fate, colour, mark: form, line: false, lines: [list.map(point)]});
      }
      return chart({title: run.sensors[sensor].name, x: timeAxis(), y: {label: "range [km]", log: true}, series, height: 260});
    }, 6, "the ranges"));
}

function detection() {
  const parts = [];
  for (const score of run.score || []) {
    if (score.sensor !== "" && (run.score.length > 7 || run.score.length === 2)) continue;
    const of = score.sensor || "all sensors";
    const bins = (list, log) => list.map((b) => {
      const at = b.from !== null && b.to !== null ? (log ? Math.sqrt(b.from * b.to) : (b.from + b.to) / 2) : b.from ?? b.to;
      return [at, b.found / b.truths, `${b.found} of ${b.truths}`, [b.low, b.high], b.theory];
    }).filter((p) => isNumber(p[0]) && (!log || p[0] > 0));
    const snr = bins(score.by_snr, true), magnitude = bins(score.by_magnitude, false);
    if (snr.length > 1) parts.push(chart({title: `Probability of detection, ${of}`, note: "with 95 % intervals; the line is of an ideal detector with the threshold 6",
      x: {label: "expected SNR", log: true}, y: {label: "Pd", least: 0, most: 1}, height: 250,
      series: [{label: "theory", colour: "c6", dash: "5 4", lines: [snr.map((p) => [p[0], p[4]])]}, {label: "found", colour: "c0", mark: "circle", line: false, lines: [snr]}]}));
    if (magnitude.length > 1 && score.sensor === "") parts.push(chart({title: `Probability of detection, ${of}`, note: "with 95 % intervals",
      x: {label: "magnitude V of the object"}, y: {label: "Pd", least: 0, most: 1}, height: 250,
      series: [{label: "found", colour: "c0", mark: "circle", line: false, lines: [magnitude]}]}));
  }
  const limits = run.sensors.map((s, k) => ({label: s.name, colour: `c${k % 8}`, mark: shapes[k % 6],
    lines: [framesOf[k].map((f) => [minutes(run.frames[f].time_s), run.frames[f].limit, `${nameOf(f)}: ${fixed(run.frames[f].limit, 2)}`])
      .filter((p) => isNumber(p[1]))]})).filter((s) => s.lines[0].length);
  const some = limits.slice(0, 16);
  if (some.length) parts.unshift(chart({title: "Limiting magnitude", note: limits.length > some.length ? `the first ${some.length} of ${limits.length} sensors; the table above has all` :
    "of a point at the detector's threshold, 5 times the noise, as each frame measured it", x: timeAxis(), y: {label: "magnitude V", flip: true}, series: some, height: 250}));
  if (parts.length) section("detection", "Detection", html("div", {class: "charts"}, parts.filter((p) => p)));
}

function tracks() {
  if (!run.track_count && !run.cue_count) return;
  const unknown = run.tracks.filter((t) => !t.number && t.curve), known = run.tracks.filter((t) => t.number && t.curve);
  const line = (t) => t.curve.map(([s, sigma]) => [minutes(s), sigma]);
  const marked = unknown.length ? new Set(unknown.slice(0, 5).map((t) => t.id)) : new Set(known.slice(0, 1).map((t) => t.id));
  const figure = chart({title: "How well tracks are known", note: "standard deviation of the position; bands are where a telescope is cued to " +
      (unknown.length ? "a track that is in no catalogue" : "the track that was cued most"),
    x: timeAxis(), y: {label: "m", log: true}, series: [
      {label: "in the catalogue", colour: "c0", lines: known.slice(0, 5).map(line)},
      {label: "in no catalogue", colour: "c1", dash: "7 3", lines: unknown.slice(0, 5).map(line)}],
    bands: run.cues.filter((c) => marked.has(c.track)).map((c) => [minutes(c.from_s), minutes(c.to_s)])});
  const trackName = (t) => t.name || (t.number ? String(t.number) : `track ${t.id ?? t.track}`);
  const parts = [figure ? html("div", {class: "charts"}, figure) : null];
  parts.push(table(counted(run.track_count, "track") + (run.tracks.length < run.track_count ? `, the first ${run.tracks.length}` : ""),
    [{title: "track"}, {title: "object", name: true}, {title: "status", name: true}, {title: "detections"}, {title: "cues"}, {title: "seen [min]"},
      {title: "altitude [km]"}, {title: "sigma at the end [m]"}],
    run.tracks.map((t) => [String(t.id), t.number ? trackName(t) : "in no catalogue", t.status, whole(t.detections), whole(t.cues),
      `${fixed(minutes(t.first_s), 1)} to ${fixed(minutes(t.last_s), 1)}`, whole(t.altitude_km), whole(t.sigma_m)])));
  if (run.cue_count) parts.push(html("h3", {}, "Cues"), table(counted(run.cue_count, "cue") + (run.cues.length < run.cue_count ? `, the first ${run.cues.length}` : ""),
    [{title: "sensor", name: true}, {title: "target", name: true}, {title: "from [min]"}, {title: "to [min]"}, {title: "exposures"}, {title: "expected information [nat]"}],
    run.cues.map((c) => [c.sensor, trackName(c), fixed(minutes(c.from_s), 2), fixed(minutes(c.to_s), 2), whole(c.exposures), fixed(c.gain_nats, 2)])));
  if (run.breakups) parts.push(html("h3", {}, "Breakups"), table(counted(run.breakups.length, "breakup"),
    [{title: "breakup"}, {title: "parent", name: true}, {title: "time [min]"}, {title: "sigma [s]"}, {title: "altitude [km]"}, {title: "confidence"}, {title: "members", name: true}],
    run.breakups.map((b) => [String(b.number), b.parent || "not known", fixed(minutes(b.time_s), 2), fixed(b.time_sigma_s, 1), whole(b.altitude_km),
      fixed(b.confidence, 4), b.members.join(", ")])));
  section("tracks", "Tracks and cues", ...parts);
}

function plan() {
  if (!run.plan.length) return;
  const parts = [html("p", {}, "Which effects ran at which level, and their mean cost in a frame: predicted by the plan and measured. Costs are wall time.")];
  const few = run.sensors.length <= 8;
  run.sensors.forEach((s, k) => {
    const rows = run.plan.filter((p) => p.sensor === k).sort((a, b) => b.measured_s - a.measured_s);
    if (!rows.length) return;
    const most = Math.max(...rows.map((p) => Math.max(p.measured_s, p.predicted_s || 0)), 1e-9);
    const bar = (value, second) => {
      const b = html("span", {class: second ? "bar second" : "bar"});
      b.style.width = `${Math.max(0, 90 * (value || 0) / most).toFixed(1)}px`;
      return b;
    };
    const sum = (key) => rows.reduce((a, p) => a + (p[key] || 0), 0);
    // A prediction is compared with what it is of: detection and writing have none.
    const foreseen = rows.filter((p) => p.predicted_s !== null).reduce((a, p) => a + p.measured_s, 0);
    const details = html("details", {open: few && k === 0}, html("summary", {}, `${s.name}: ${seconds(sum("measured_s"))} a frame` +
      (foreseen ? `; effects with a prediction take ${seconds(foreseen)} of it, predicted ${seconds(sum("predicted_s"))}` : "")));
    const fill = () => {
      if (details.dataset.filled) return;
      details.dataset.filled = "yes";
      details.append(table(`Effects of ${s.name}`, [{title: "effect", name: true}, {title: "level (frames)", name: true}, {title: "predicted"}, {title: "measured"},
        {title: "predicted, measured", name: true}, {title: "why", name: true, why: true}], rows.map((p) => [p.effect,
        Object.entries(p.levels).map(([level, frames]) => `${level} (${frames})`).join(", ") || "–", p.predicted_s === null ? "–" : seconds(p.predicted_s),
        seconds(p.measured_s), html("span", {}, bar(p.predicted_s, true), html("br"), bar(p.measured_s, false)), p.why || ""])));
    };
    details.addEventListener("toggle", fill);
    if (few && k === 0) fill();
    parts.push(details);
  });
  section("plan", "Plan of effects", ...parts);
}

function clock() {
  if (!run.ticks.length && !run.nodes.length) return;
  const parts = [];
  if (run.ticks.length) {
    const ended = new Map();
    for (const t of run.ticks) ended.set(t[3], (ended.get(t[3]) || 0) + 1);
    const held = [...ended.entries()].sort((a, b) => b[1] - a[1]), waits = [...run.waited_for].sort((a, b) => b[1] - a[1]);
    const top = held.slice(0, 6).map(([name]) => name);
    const series = [{label: "granted", colour: "c6", thin: true, dash: "3 3", lines: [run.ticks.map((t) => [t[1], t[0]])]}];
    top.forEach((name, k) => series.push({label: `done, last by ${name || "nobody"}`, colour: `c${k}`, mark: shapes[k], line: false, size: 2.6,
      lines: [run.ticks.filter((t) => t[3] === name).map((t) => [t[2], t[0], `tick ${t[0]}: done at ${fixed(t[2], 3)} s, last by ${name}`])]}));
    if (held.length > 6) series.push({label: "done, last by others", colour: "c7", mark: "circle", line: false, size: 2,
      lines: [run.ticks.filter((t) => !top.includes(t[3])).map((t) => [t[2], t[0], `tick ${t[0]}: last by ${t[3]}`])]});
    const note = run.ticks.length < run.tick_count ? `the last ${run.ticks.length} of ${run.tick_count} ticks` : "when each tick was granted, when all had done it, and who was last";
    parts.push(html("div", {class: "charts"}, chart({title: "Ticks", note, x: {label: "wall time [s]"}, y: {label: "tick"}, series, height: 320}),
      waits.length ? html("div", {}, table("Whom the clock waited for: who had all input and was not done",
        [{title: "node", name: true}, {title: "waited for [s]"}, {title: "ticks that it ended"}],
        waits.slice(0, 50).map(([name, s]) => [name, fixed(s, 2), whole(ended.get(name) || 0)]))) : null));
  }
  if (run.nodes.length) {
    const most = Math.max(...run.nodes.map((n) => n.compute_s + n.messaging_s + n.waiting_s), 1e-9);
    parts.push(table("Time of each node" + (run.parts > 1 ? ", in the last part of the run" : ""), [{title: "node", name: true}, {title: "computing [s]"}, {title: "messaging [s]"}, {title: "waiting [s]"},
      {title: "start [s]"}, {title: "share of computing", name: true}], run.nodes.map((n) => {
      const bar = html("span", {class: "bar"});
      bar.style.width = `${(120 * n.compute_s / most).toFixed(1)}px`;
      return [n.name, fixed(n.compute_s, 2), fixed(n.messaging_s, 2), fixed(n.waiting_s, 2), fixed(n.start_s, 2), bar];
    })));
  }
  section("clock", "Timeline", ...parts);
}

function files() {
  section("files", "Files", html("ul", {}, run.files.map((path) => html("li", {}, link(path)))));
}

header();
const nav = html("nav", {"aria-label": "Sections"});
page.append(nav);
summary();
frames();
skies();
ranges();
detection();
tracks();
plan();
clock();
files();
nav.append(html("ul", {}, sections.map(([id, title]) => html("li", {}, html("a", {href: `#${id}`}, title)))));
document.documentElement.dataset.ready = "yes";
drawUnseen();
