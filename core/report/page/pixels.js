// Pixels and directions of a frame.

function bytesOf(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}
async function inflate(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const opened = new Map();  // views, the last used at the end
function openView(number) {
  let view = opened.get(number);
  opened.delete(number);
  view ||= readView(run.views[number]);
  opened.set(number, view);
  if (opened.size > 16) opened.delete(opened.keys().next().value);
  return view;
}

async function readView(data) {
  if (data.problem) throw new Error(data.problem);
  const view = {...data};
  const bytes = await inflate(data.pixels), size = data.across * data.down;
  view.numbers = new Uint16Array(size);
  for (let k = 0, above = 0; k < size;) {  // differences from the left; in the first column from above
    let left = above;
    for (let x = 0; x < data.across; ++x, ++k) {
      view.numbers[k] = left = (left + (bytes[k] | (bytes[size + k] << 8))) & 0xffff;
      if (x === 0) above = left;
    }
  }
  view.valueOf = (number) => data.least_dn + data.step_dn * number;
  if (data.grid) view.directionOf = await directions(data);
  return view;
}

/** The direction of a pixel by cubics through the nodes of a grid: {ra, dec} in degrees, or null for no sky. */
async function directions(data) {
  const g = data.grid, wide = g.across + 3, size = wide * (g.down + 3);
  const bytes = await inflate(g.nodes), nodes = new Int32Array(3 * size);
  for (let k = 0; k < nodes.length; ++k)
    for (let b = 0; b < 4; ++b) nodes[k] |= bytes[b * nodes.length + k] << (8 * b);
  const sky = g.sky ? await inflate(g.sky) : null;
  const weights = (t) =>
    [-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2, (t + 1) * t * (t - 1) / 6];
  return (x, y) => {
    const u = (x + 0.5) / data.columns, v = (y + 0.5) / data.rows;
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return null;
    if (sky) {
      const i = Math.min(g.sky_across - 1, Math.floor(u * g.sky_across));
      const j = Math.min(g.sky_down - 1, Math.floor(v * g.sky_down));
      if (!sky[j * g.sky_across + i]) return null;
    }
    const i = Math.min(g.across - 1, Math.floor(u * g.across)), j = Math.min(g.down - 1, Math.floor(v * g.down));
    const wx = weights(u * g.across - i), wy = weights(v * g.down - j), sum = [0, 0, 0];
    for (let axis = 0; axis < 3; ++axis)
      for (let b = 0; b < 4; ++b)
        for (let a = 0; a < 4; ++a) sum[axis] += wx[a] * wy[b] * nodes[axis * size + (j + b) * wide + i + a];
    const ra = Math.atan2(sum[1], sum[0]) * 180 / Math.PI;
    return {ra: ra < 0 ? ra + 360 : ra, dec: Math.atan2(sum[2], Math.hypot(sum[0], sum[1])) * 180 / Math.PI};
  };
}

/** Numbers of the darkest and the brightest grey, and the curve between them. */
function stretchOf(view, name) {
  const step = Math.max(1, Math.floor(view.numbers.length / 20000)), sample = [];
  for (let k = 0; k < view.numbers.length; k += step) sample.push(view.numbers[k]);
  sample.sort((a, b) => a - b);
  const quantile = (q) => sample[Math.min(sample.length - 1, Math.floor(q * sample.length))];
  if (name === "zscale") {
    const [low, high] = zscale(sample);
    return {low, high, curve: (v) => v};
  }
  if (name === "log") {
    // The sky is at 0.3 of white.
    const low = quantile(0.02), high = Math.max(low + 1, quantile(0.9995)), sky = (quantile(0.5) - low) / (high - low);
    let gain = 0.01;
    while (gain < 1e4 && Math.log1p(gain * sky) / Math.log1p(gain) < 0.3) gain *= 1.2;
    return {low, high, curve: (v) => Math.log1p(gain * v) / Math.log1p(gain)};
  }
  const low = quantile(0.001);
  return {low, high: Math.max(low + 1, quantile(0.9995)), curve: (v) => v};
}

/** Limits by a line through the sorted sample, without what is far from it (as IRAF's display has it, contrast 0.25). */
function zscale(sorted) {
  const least = sorted[0], most = sorted[sorted.length - 1], every = Math.max(1, Math.floor(sorted.length / 1000));
  const values = sorted.filter((_, k) => k % every === 0), n = values.length, middle = (n - 1) / 2;
  let good = values.map(() => true), slope = 0, offset = 0, count = n;
  for (let round = 0; round < 5; ++round) {
    let sx = 0, sy = 0, sxx = 0, sxy = 0, m = 0;
    values.forEach((v, k) => { if (good[k]) { const x = k - middle; ++m; sx += x; sy += v; sxx += x * x; sxy += x * v; } });
    const d = m * sxx - sx * sx;
    if (m < 5 || d === 0) break;
    slope = (m * sxy - sx * sy) / d;
    offset = (sy - slope * sx) / m;
    const rest = values.map((v, k) => v - offset - slope * (k - middle));
    let sum = 0;
    rest.forEach((r, k) => { if (good[k]) sum += r * r; });
    const limit = 2.5 * Math.sqrt(sum / m), next = rest.map((r) => Math.abs(r) <= limit);
    count = next.filter((g) => g).length;
    if (count === m) break;
    good = next;
  }
  const median = values[Math.floor(n / 2)];
  if (count < n / 2) return [least, Math.max(least + 1, most)];
  const rise = slope / 0.25;
  const low = Math.max(least, median - rise * middle), high = Math.min(most, median + rise * (n - 1 - middle));
  return [low, Math.max(low + 1, high)];
}

/** The pixels of a view as a picture. */
function pictureOf(view, stretch) {
  const {low, high, curve} = stretchOf(view, stretch), grey = new Uint8ClampedArray(65536);
  for (let k = 0; k < 65536; ++k) grey[k] = 255 * curve(Math.min(1, Math.max(0, (k - low) / (high - low))));
  const canvas = html("canvas", {width: view.across, height: view.down});
  const image = new ImageData(view.across, view.down);
  for (let k = 0; k < view.numbers.length; ++k) {
    image.data[4 * k] = image.data[4 * k + 1] = image.data[4 * k + 2] = grey[view.numbers[k]];
    image.data[4 * k + 3] = 255;
  }
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
