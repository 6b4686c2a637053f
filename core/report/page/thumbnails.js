// Small pictures of frames, drawn when they come into sight.

async function drawThumbnail(canvas, frame) {
  const view = await openView(run.frames[frame].view);
  const context = canvas.getContext("2d");
  const scale = Math.min(canvas.width / view.columns, canvas.height / view.rows);
  const left = (canvas.width - view.columns * scale) / 2, top = (canvas.height - view.rows * scale) / 2;
  context.imageSmoothingQuality = "high";
  context.drawImage(pictureOf(view, "log"), left, top, view.across * view.bin * scale, view.down * view.bin * scale);
  drawMarks(context, frame, {stars: view.stars?.slice(0, 25)}, (x, y) => [left + (x + 0.5) * scale, top + (y + 0.5) * scale],
    everything, 7);
  canvas.dataset.drawn = "yes";
}
const whenSeen = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    whenSeen.unobserve(entry.target);
    drawThumbnail(entry.target, Number(entry.target.dataset.frame)).catch((problem) => { entry.target.title = problem.message; });
  }
}, {rootMargin: "300px"});
/** Draws, one by one, what nobody has scrolled to: pictures are there for a print and a quick thumb. */
async function drawUnseen() {
  for (;;) {
    const canvas = page.querySelector(".thumb canvas[data-frame]:not([data-drawn]):not([title])");
    if (!canvas) return;
    whenSeen.unobserve(canvas);
    await drawThumbnail(canvas, Number(canvas.dataset.frame)).catch((problem) => { canvas.title = problem.message; });
    await new Promise((go) => setTimeout(go, 20));
  }
}

function countsOf(frame) {
  const fates = {};
  for (const t of truthsOf[frame]) fates[t.fate] = (fates[t.fate] || 0) + 1;
  const alarms = detectionsOf[frame].filter((d) => !d.ofTruth).length;
  return {found: fates.found || 0, missed: fates.missed || 0, faint: fates.faint || 0, alarms};
}

function thumbnail(frame) {
  const f = run.frames[frame], c = countsOf(frame);
  const words = f.sources === false ? "not marked in this page" : run.has_truth ? `${c.found} found, ${c.missed} missed, ${c.alarms} false` : `${detectionsOf[frame].length} detections`;
  let picture;
  if (f.view !== undefined) {
    picture = html("canvas", {width: 480, height: 360, "data-frame": frame, "aria-hidden": "true"});
    whenSeen.observe(picture);
  } else if (f.picture || f.marked) {
    picture = html("img", {src: (f.marked || f.picture).split("/").map(encodeURIComponent).join("/"), loading: "lazy", alt: ""});
  } else {
    picture = html("canvas", {width: 4, height: 3, "aria-hidden": "true"});
  }
  return html("button", {class: "thumb", type: "button", "data-open": frame, onclick: () => viewer.open(frame)}, picture,
    html("span", {}, html("b", {}, `Frame ${f.number}`), ` ${f.utc.slice(11, 19)} UTC`, html("br"), words));
}

const firstShown = 8;
function thumbnails(sensor) {
  const grid = html("div", {class: "thumbs"}), frames = framesOf[sensor];
  const first = run.sensors.length > 20 ? 4 : firstShown;
  grid.append(...frames.slice(0, first).map(thumbnail));
  if (frames.length <= first) return grid;
  let next = first;
  const more = html("button", {type: "button", onclick: () => {
    grid.append(...frames.slice(next, next + 100).map(thumbnail));
    next += 100;
    if (next >= frames.length) more.remove();
    else more.textContent = label();
  }});
  const label = () => `Show ${Math.min(100, frames.length - next)} more of ${frames.length} frames`;
  more.textContent = label();
  return html("div", {}, grid, html("p", {}, more));
}
