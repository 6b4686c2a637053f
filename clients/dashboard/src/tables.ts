// The table of nodes, as `dmise status` shows it with rates, lags and gaps, and that of tracks and cues.
import type { Status, Task, Track } from "./messages";

const node_columns = ["node", "state", "tick", "lag", "ticks/s", "frames", "found", "gaps", "starts", "compute s", "message s", "wait s"];
const track_columns = ["track", "object", "status", "seen s", "found", "sigma km"];
const most_rows = 60;

function fill(table: HTMLTableElement, columns: string[], rows: { cells: (string | number)[]; kind: string }[]): void {
  if (!table.tHead!.rows.length) {
    const head = table.tHead!.insertRow();
    for (const name of columns) {
      const cell = document.createElement("th");
      cell.scope = "col";
      cell.textContent = name;
      head.append(cell);
    }
  }
  const body = table.tBodies[0]!;
  while (body.rows.length > rows.length) body.deleteRow(-1);
  for (const [i, { cells, kind }] of rows.entries()) {
    let row = body.rows[i];
    if (!row) {
      row = body.insertRow();
      for (let c = 0; c < columns.length; ++c) {
        const cell = document.createElement(c === 0 ? "th" : "td");
        if (c === 0) (cell as HTMLTableCellElement).scope = "row";
        row.append(cell);
      }
    }
    if (row.className !== kind) row.className = kind;
    for (const [c, value] of cells.entries()) {
      const text = String(value);
      if (row.cells[c]!.textContent !== text) row.cells[c]!.textContent = text;
    }
  }
}

export function show_nodes(table: HTMLTableElement, status: Status): void {
  fill(table, node_columns, status.nodes.map((n) => ({
    kind: n.state,
    cells: [n.name, n.state, n.tick < 0 ? "" : n.tick, n.lag_ticks, n.ticks_per_s.toFixed(1), n.frames, n.detections, n.gaps, n.start,
      n.compute_s.toFixed(1), n.message_s.toFixed(1), n.wait_s.toFixed(1)],
  })));
}

export function show_tracks(table: HTMLTableElement, tracks: Track[], tasks: Task[], time_s: number): void {
  const cues = tasks.filter((t) => t.end_s >= time_s).map((t) => ({
    kind: "cue",
    cells: [`cue ${t.id}`, t.name || `track ${t.track}`, `${t.sensor} at ${t.on_target_s.toFixed(0)} s`, "", t.exposures, ""],
  }));
  const latest = [...tracks].sort((a, b) => b.last_seen_s - a.last_seen_s).slice(0, most_rows);
  fill(table, track_columns, [...cues, ...latest.map((t) => ({
    kind: t.status,
    cells: [t.id, t.name || (t.number ? String(t.number) : "unknown"), t.status, t.last_seen_s.toFixed(0), t.detections,
      t.sigma_km < 10 ? t.sigma_km.toFixed(3) : t.sigma_km.toFixed(0)],
  }))]);
}
