// Messages of the gateway (nodes/gateway/live_view.h) and the connection that brings them. Positions are ITRS [km].
export type Triple = [number, number, number];

export interface Run { type: "run"; start_utc: string; start_utc_ms: number | null; tick_s: number; last_tick: number }
export interface NodeState {
  name: string; state: string; tick: number; start: number; lag_ticks: number; ticks_per_s: number;
  compute_s: number; message_s: number; wait_s: number; frames: number; detections: number; peak_resident_bytes: number; gaps: number;
}
export interface Status {
  type: "status"; run_id: string; phase: string; paused: boolean; pace: number; cause: string; settled_tick: number; granted_tick: number;
  last_tick: number; time_s: number; rate: number; ticks_per_s: number; overruns: number; worst_lag_s: number;
  missing: string[]; holding: string[]; past: { from_s: number; to_s: number; states: number }; nodes: NodeState[];
}
export interface Sensor {
  name: string; frame: number; start_s: number; end_s: number; columns: number; rows: number; ra_rad: number; dec_rad: number;
  scale_rad: number; limiting_magnitude: number; background_e: number; noise_e: number; stars_expected: number; stars_found: number;
  objects_rendered: number; detections: number; detection_off: boolean; shutter_closed: boolean; detections_total: number;
  position_km: Triple; boresight: Triple; field: number[];
}
export interface Detection {
  id: string; sensor: string; frame: number; time_s: number; kind: "point" | "streak"; x_px: number; y_px: number; magnitude: number;
  snr: number; ra_rad: number; dec_rad: number; ends_px: [number, number, number, number]; from_km?: Triple; direction?: Triple;
}
/// What was in a frame: pixels at the start, middle and end of the exposure.
export interface Truth {
  sensor: string; frame: number; number: number; name: string; magnitude: number; signal_e: number;
  path_px: [number, number, number, number, number, number];
}
export interface Track {
  id: number; status: string; time_s: number; last_seen_s: number; number: number; name: string; detections: number;
  existence: number; sigma_km: number; position_km: Triple;
}
export interface Task {
  id: number; sensor: string; track: number; number: number; name: string; start_s: number; on_target_s: number; end_s: number;
  exposures: number; gain_nats: number; sigma_rad: number; path_km: number[];
}
export interface Objects { type: "objects"; time_s: number; utc_ms: number; position_km: Float32Array }

export type Message =
  | Run | Status | Objects
  | { type: "welcome"; may_control: boolean; sees_truth: boolean }
  | { type: "truth"; truths: Truth[] }
  | { type: "roster"; objects: [number, string][] }
  | { type: "sensors"; sensors: Sensor[] }
  | { type: "detections"; detections: Detection[] }
  | { type: "tracks"; tracks: Track[] }
  | { type: "tasks"; tasks: Task[] }
  | { type: "past"; time_s: number }
  | { type: "notice"; text: string }
  | { type: "refused"; text: string };

export type Command =
  | { do: "pause" } | { do: "go-on" } | { do: "step"; ticks: number } | { do: "pace"; factor: number } | { do: "past"; time_s: number } | { do: "live" };

const magic = 0x424f4d44; // "DMOB", little endian
const header_bytes = 24;

export function read_objects(bytes: ArrayBuffer): Objects | null {
  if (bytes.byteLength < header_bytes) return null;
  const view = new DataView(bytes);
  const count = view.getUint32(4, true);
  if (view.getUint32(0, true) !== magic || bytes.byteLength !== header_bytes + 12 * count) return null;
  return {
    type: "objects", time_s: view.getFloat64(8, true), utc_ms: view.getFloat64(16, true),
    position_km: new Float32Array(bytes, header_bytes, 3 * count),
  };
}

/** Connects, and connects again when the connection breaks. */
export class Connection {
  private socket: WebSocket | null = null;
  private wait_ms = 500;

  constructor(private readonly heard: (message: Message) => void, private readonly state: (connected: boolean) => void) {
    this.open();
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  private open(): void {
    const socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => { this.wait_ms = 500; this.state(true); };
    socket.onmessage = (event) => {
      const message = typeof event.data === "string" ? (JSON.parse(event.data) as Message) : read_objects(event.data);
      if (message) this.heard(message);
    };
    socket.onclose = () => {
      this.state(false);
      setTimeout(() => this.open(), this.wait_ms);
      this.wait_ms = Math.min(2 * this.wait_ms, 10_000);
    };
    this.socket = socket;
  }
}
