// The full frame in a dialog.

const angle = {
  hours(ra) {
    const s = ((ra / 15) * 3600 + 0.0005) % 86400;
    const two = (v) => String(Math.floor(v)).padStart(2, "0");
    return `${two(s / 3600)}h ${two(s / 60 % 60)}m ${(Math.floor(s % 60 * 1000) / 1000).toFixed(3).padStart(6, "0")}s`;
  },
  degrees(dec) {
    const s = Math.abs(dec) * 3600 + 0.005, two = (v) => String(Math.floor(v)).padStart(2, "0");
    return `${dec < 0 ? "−" : "+"}${two(s / 3600)}° ${two(s / 60 % 60)}′ ${(Math.floor(s % 60 * 100) / 100).toFixed(2).padStart(5, "0")}″`;
  },
};

const viewer = (() => {
  const canvas = html("canvas", {tabindex: "0", role: "application", "aria-label":
    "Frame. Arrow keys move the cross, with shift by 10 pixels; plus and minus zoom, 0 shows all, n and p change the frame."});
  const title = html("h2", {id: "viewer-title"});
  const readout = html("div", {class: "readout", "aria-live": "polite"});
  const links = html("span", {});
  const shown = {...everything};
  const stretch = html("select", {"aria-label": "Stretch", onchange: () => { picture = null; draw(); }},
    ["log", "linear", "zscale"].map((name) => html("option", {value: name}, name)));
  const layer = (kind, text, ...symbols) => html("label", {}, html("input", {type: "checkbox", checked: true,
    onchange: (event) => { shown[kind] = event.target.checked; draw(); }}), ...symbols.map(symbol), text);
  const button = (text, name, act) => html("button", {type: "button", "aria-label": name, title: name, onclick: act}, text);
  const stage = html("div", {class: "stage"}, canvas);
  const dialog = html("dialog", {"aria-labelledby": "viewer-title", onclose: () => { last?.focus(); }},
    html("div", {class: "tools"}, title, links, button("✕", "Close", () => dialog.close())),
    html("div", {class: "tools"}, button("‹", "Previous frame (p)", () => step(-1)), button("›", "Next frame (n)", () => step(1)),
      html("label", {}, "Stretch ", stretch), button("−", "Zoom out (-)", () => zoom(1 / 1.5)), button("+", "Zoom in (+)", () => zoom(1.5)),
      button("All", "Show all of the frame (0)", () => { fit(); draw(); }),
      html("span", {class: "legend"}, layer("star", "stars", "star"), layer("truth", "truth", "found", "missed", "faint"),
        layer("detection", "detections", "detection"), layer("alarm", "false alarms", "alarm"))),
    stage, readout);
  document.body.append(dialog);

  let frame = 0, view = null, picture = null, scale = 1, left = 0, top = 0, cross = null, last = null, serial = 0, image = null;
  const columns = () => view ? view.columns : run.sensors[run.frames[frame].sensor].columns || image?.naturalWidth || 1;
  const rows = () => view ? view.rows : run.sensors[run.frames[frame].sensor].rows || image?.naturalHeight || 1;

  function fit() {
    const box = stage.getBoundingClientRect();
    scale = Math.min(box.width / columns(), box.height / rows());
    left = (box.width - columns() * scale) / 2;
    top = (box.height - rows() * scale) / 2;
  }
  const place = (x, y) => [left + (x + 0.5) * scale, top + (y + 0.5) * scale];
  const pixelAt = (u, v) => [(u - left) / scale - 0.5, (v - top) / scale - 0.5];

  function draw() {
    const box = stage.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    canvas.width = Math.max(1, Math.round(box.width * ratio));
    canvas.height = Math.max(1, Math.round(box.height * ratio));
    Object.assign(canvas.dataset, {scale, left, top});
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    if (view) {
      picture ||= pictureOf(view, stretch.value);
      context.imageSmoothingEnabled = scale * view.bin < 1;
      context.drawImage(picture, left, top, view.across * view.bin * scale, view.down * view.bin * scale);
    } else if (image?.complete && image.naturalWidth) {
      context.drawImage(image, left, top, columns() * scale, rows() * scale);
    }
    drawMarks(context, frame, view, place, shown, Math.min(22, Math.max(8, 8 * Math.sqrt(scale * 3))));
    if (cross) {
      const [u, v] = place(...cross);
      context.strokeStyle = "#ffffff";
      context.lineWidth = 1;
      context.beginPath();
      context.moveTo(u - 14, v); context.lineTo(u - 4, v); context.moveTo(u + 4, v); context.lineTo(u + 14, v);
      context.moveTo(u, v - 14); context.lineTo(u, v - 4); context.moveTo(u, v + 4); context.lineTo(u, v + 14);
      context.stroke();
    }
  }

  function zoom(factor, u, v) {
    const box = stage.getBoundingClientRect();
    if (u === undefined) [u, v] = cross ? place(...cross) : [box.width / 2, box.height / 2];
    const whole = Math.min(box.width / columns(), box.height / rows());
    const next = Math.min(60, Math.max(whole * 0.8, scale * factor));
    left = u - (u - left) * next / scale;
    top = v - (v - top) * next / scale;
    scale = next;
    draw();
  }

  /** What is marked nearest to a place on the screen, in words. */
  function nearest(u, v) {
    let best = 14, words = "";
    const consider = (x, y, text) => {
      const [a, b] = place(x, y), distance = Math.hypot(a - u, b - v);
      if (distance < best) { best = distance; words = text(); }
    };
    if (shown.star) for (const [id, x, y, ra, dec, magnitude] of view?.stars || [])
      consider(x, y, () => `star ${id}: V ${fixed(magnitude, 2)}, RA ${fixed(ra, 5)}°, Dec ${fixed(dec, 5)}°`);
    if (shown.truth) for (const t of truthsOf[frame]) if (kindOfFate[t.fate])
      for (const p of trail(t)) consider(p[0], p[1], () =>
        `${t.object}: ${t.fate}, V ${fixed(t.magnitude, 2)}, expected SNR ${fixed(t.snr, 1)}, range ${whole(t.range)} km`);
    for (const d of detectionsOf[frame]) if (shown[d.ofTruth ? "detection" : "alarm"])
      consider(d.x, d.y, () => `${d.ofTruth ? "detection" : "false alarm"} (${d.streak ? "streak" : "point"}): ` +
        `magnitude ${fixed(d.magnitude, 2)}, SNR ${fixed(d.snr, 1)}, RA ${fixed(d.ra, 5)}°, Dec ${fixed(d.dec, 5)}°`);
    return words;
  }

  function tell(x, y) {
    const parts = [`x ${x.toFixed(1)}, y ${y.toFixed(1)}`], data = readout.dataset;
    Object.assign(data, {x, y, ra: "", dec: "", value: ""});
    if (view && x >= -0.5 && y >= -0.5 && x < view.columns - 0.5 && y < view.rows - 0.5) {
      const i = Math.floor((x + 0.5) / view.bin), j = Math.floor((y + 0.5) / view.bin);
      const value = view.valueOf(view.numbers[j * view.across + i]);
      data.value = value;
      parts.push(`${value.toFixed(view.bin > 1 || view.step_dn % 1 ? 1 : 0)} DN` +
        (view.bin > 1 ? ` (mean of ${view.bin} × ${view.bin} pixels)` : ""));
      const sky = view.directionOf ? view.directionOf(x, y) : null;
      if (sky) {
        Object.assign(data, sky);
        parts.push(`RA ${sky.ra.toFixed(6)}° (${angle.hours(sky.ra)}), Dec ${sky.dec.toFixed(6)}° (${angle.degrees(sky.dec)})`);
      } else if (view.directionOf) {
        parts.push("no sky here");
      }
    }
    readout.textContent = parts.join("   ") + "\n" + nearest(...place(x, y));
  }

  async function show(next) {
    const mine = ++serial, f = run.frames[next], sensor = run.sensors[f.sensor];
    frame = next;
    view = picture = cross = image = null;
    title.textContent = `${sensor.name}, frame ${f.number}, ${f.utc.slice(0, 19).replace("T", " ")} UTC`;
    links.replaceChildren();
    for (const [path, text] of [[f.fits, "FITS"], [f.picture, "PNG"], [f.marked, "marked PNG"], [sensor.log, "log"]])
      if (path) links.append(link(path, text), " ");
    readout.textContent = "";
    delete dialog.dataset.ready;
    stretch.disabled = f.view === undefined;
    let problem = "";
    if (f.view !== undefined) {
      try {
        const opening = await openView(f.view);
        if (mine !== serial) return;
        view = opening;
      } catch (error) {
        problem = error.message;
      }
    }
    if (!view && f.picture) {
      image = html("img", {alt: ""});
      image.onload = () => { if (mine === serial) { fit(); draw(); } };
      image.src = f.picture.split("/").map(encodeURIComponent).join("/");
      problem ||= "This frame's pixels are not in the page: the picture is its PNG. Its FITS file has them.";
    } else if (!view) {
      problem ||= "There is no FITS file and no picture of this frame.";
    }
    readout.textContent = problem || "Move over the frame, or use the arrow keys, to read it.";
    fit();
    draw();
    dialog.dataset.ready = frame;
  }
  function step(by) {
    const list = framesOf[run.frames[frame].sensor], at = list.indexOf(frame) + by;
    if (at >= 0 && at < list.length) show(list[at]);
  }

  let dragged = null;
  canvas.addEventListener("pointerdown", (event) => {
    dragged = [event.offsetX - left, event.offsetY - top];
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointerup", () => { dragged = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (dragged && event.buttons) {
      [left, top] = [event.offsetX - dragged[0], event.offsetY - dragged[1]];
      draw();
    }
    tell(...pixelAt(event.offsetX, event.offsetY));
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom(Math.exp(-event.deltaY / 400), event.offsetX, event.offsetY);
  }, {passive: false});
  dialog.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === "SELECT") return;
    const by = event.shiftKey ? 10 : 1;
    const move = {ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, -by], ArrowDown: [0, by]}[event.key];
    if (move && event.target === canvas) {
      cross ||= [Math.round(columns() / 2) - move[0], Math.round(rows() / 2) - move[1]];
      cross = [Math.min(columns() - 1, Math.max(0, cross[0] + move[0])), Math.min(rows() - 1, Math.max(0, cross[1] + move[1]))];
      draw();
      tell(...cross);
    } else if (event.key === "+" || event.key === "=") zoom(1.5);
    else if (event.key === "-") zoom(1 / 1.5);
    else if (event.key === "0") { fit(); draw(); }
    else if (event.key === "n") step(1);
    else if (event.key === "p") step(-1);
    else return;
    event.preventDefault();
  });
  new ResizeObserver(() => { if (dialog.open) draw(); }).observe(stage);

  return {open(number) {
    last = document.activeElement;
    dialog.showModal();
    show(number);
    canvas.focus();
  }};
})();
