// Marks on a frame, by colour and by shape, and what belongs to it.

// Okabe and Ito's colours, which the colour-blind tell apart; on a black frame.
const mark = {
  star: {colour: "#f0a3d0", label: "star"},
  found: {colour: "#00c98f", label: "truth, found"},
  missed: {colour: "#ff7033", label: "truth, missed", dash: [6, 4]},
  faint: {colour: "#7fae9c", label: "truth, too faint", dash: [2, 4]},
  detection: {colour: "#56c8ff", label: "detection"},
  alarm: {colour: "#f0e442", label: "false alarm"},
};
const kindOfFate = {found: "found", missed: "missed", faint: "faint"};

function symbol(kind) {
  const m = mark[kind];
  const shape = {
    star: svg("path", {d: "M11 2v4M11 10v4M4 8h4M14 8h4"}),
    found: svg("circle", {cx: 11, cy: 8, r: 6}),
    missed: svg("path", {d: "M11 2a6 6 0 1 0 .1 0M7 4l8 8M15 4l-8 8"}),
    faint: svg("circle", {cx: 11, cy: 8, r: 6, "stroke-dasharray": "2 3"}),
    detection: svg("path", {d: "M5 2h12v12H5z"}),
    alarm: svg("path", {d: "M11 2l7 12H4z"}),
  }[kind];
  shape.setAttribute("fill", "none");
  shape.setAttribute("stroke", m.colour);
  shape.setAttribute("stroke-width", "1.6");
  return svg("svg", {viewBox: "0 0 22 16", "aria-hidden": "true"}, shape);
}

const truthsOf = run.frames.map(() => []), detectionsOf = run.frames.map(() => []);
for (const t of run.truths) {
  truthsOf[t[0]].push({
    object: run.objects[t[1]], fate: run.fate_names[t[2]], start: [t[3], t[4]], middle: [t[5], t[6]], end: [t[7], t[8]],
    ra: t[9], dec: t[10], magnitude: t[11], snr: t[12], range: t[13], angle: t[14], height: t[15], frame: t[0],
  });
}
for (const d of run.detections) {
  detectionsOf[d[0]].push({
    streak: d[1] === 1, ofTruth: d[2] === 1 || !run.has_truth, x: d[3], y: d[4], end1: [d[5], d[6]], end2: [d[7], d[8]],
    ra: d[9], dec: d[10], magnitude: d[11], snr: d[12],
  });
}
const framesOf = run.sensors.map(() => []);
run.frames.forEach((f, k) => framesOf[f.sensor].push(k));
const nameOf = (frame) => `${run.sensors[run.frames[frame].sensor].name}, frame ${run.frames[frame].number}`;

/** Points along a trail through its start, middle and end, which is a parabola in time. */
function trail(t, pieces = 16) {
  const points = [];
  for (let k = 0; k <= pieces; ++k) {
    const u = k / pieces, a = (1 - u) * (1 - 2 * u), b = 4 * u * (1 - u), c = u * (2 * u - 1);
    points.push([a * t.start[0] + b * t.middle[0] + c * t.end[0], a * t.start[1] + b * t.middle[1] + c * t.end[1]]);
  }
  return points;
}

/** Draws marks; `place` turns pixels of the frame into those of the context. */
function drawMarks(context, frame, view, place, shown, size) {
  const line = (points, closed) => {
    context.beginPath();
    points.forEach((p, k) => k ? context.lineTo(p[0], p[1]) : context.moveTo(p[0], p[1]));
    if (closed) context.closePath();
    context.stroke();
  };
  const use = (kind) => {
    context.strokeStyle = mark[kind].colour;
    context.setLineDash(mark[kind].dash || []);
  };
  context.lineWidth = size > 5 ? 1.6 : 1.1;
  if (shown.star && view?.stars) {
    use("star");
    for (const [, x, y, , , magnitude] of view.stars) {
      const [u, v] = place(x, y), near = size * 0.45, far = size * (magnitude < 3 ? 1.3 : 0.95);
      for (const [dx, dy] of [[0, -1], [0, 1], [-1, 0], [1, 0]])
        line([[u + dx * near, v + dy * near], [u + dx * far, v + dy * far]]);
    }
  }
  if (shown.truth) {
    for (const t of truthsOf[frame]) {
      const kind = kindOfFate[t.fate];
      if (!kind) continue;
      use(kind);
      const points = trail(t).map((p) => place(p[0], p[1]));
      const length = Math.hypot(points[16][0] - points[0][0], points[16][1] - points[0][1]);
      const [u, v] = points[8];
      if (length < size) {
        context.beginPath();
        context.arc(u, v, size, 0, 2 * Math.PI);
        context.stroke();
      } else {
        const left = [], right = [];
        points.forEach((p, k) => {
          const a = points[Math.max(0, k - 1)], b = points[Math.min(16, k + 1)];
          const n = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1, nx = -(b[1] - a[1]) / n * size, ny = (b[0] - a[0]) / n * size;
          left.push([p[0] + nx, p[1] + ny]);
          right.unshift([p[0] - nx, p[1] - ny]);
        });
        line([...left, ...right], true);
      }
      if (t.fate === "missed") {
        context.setLineDash([]);
        line([[u - size * 0.7, v - size * 0.7], [u + size * 0.7, v + size * 0.7]]);
        line([[u + size * 0.7, v - size * 0.7], [u - size * 0.7, v + size * 0.7]]);
      }
    }
  }
  for (const d of detectionsOf[frame]) {
    const kind = d.ofTruth ? "detection" : "alarm";
    if (!shown[kind]) continue;
    use(kind);
    const [u, v] = place(d.x, d.y), r = size * 0.72;
    if (d.streak) line([place(...d.end1), place(...d.end2)]);
    if (kind === "detection") line([[u - r, v - r], [u + r, v - r], [u + r, v + r], [u - r, v + r]], true);
    else line([[u, v - 1.5 * r], [u + 1.3 * r, v + r], [u - 1.3 * r, v + r]], true);
  }
  context.setLineDash([]);
}
const everything = {star: true, truth: true, detection: true, alarm: true};
