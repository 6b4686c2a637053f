import "@cesium/engine/Source/Widget/CesiumWidget.css";
import "./style.css";
import { Chart } from "./charts";
import { FrameView } from "./frame_view";
import { Globe } from "./globe";
import { Connection, type Detection, type Message, type Run, type Sensor, type Status, type Task, type Track, type Truth } from "./messages";
import { palette } from "./palette";
import { Speed } from "./speed";
import { show_nodes, show_tracks } from "./tables";

const by_id = <T extends HTMLElement>(id: string): T => document.getElementById(id) as T;

const sensor_list = by_id<HTMLSelectElement>("sensor"), stretch = by_id<HTMLSelectElement>("stretch");
const pause = by_id<HTMLButtonElement>("pause"), step = by_id<HTMLButtonElement>("step"), live = by_id<HTMLButtonElement>("live");
const step_ticks = by_id<HTMLInputElement>("step-ticks"), past = by_id<HTMLInputElement>("past");
const truth = by_id<HTMLInputElement>("truth"), speed_list = by_id<HTMLSelectElement>("speed");
const notice = by_id("notice");

let run: Run | null = null;
let status: Status | null = null;
let sensors: Sensor[] = [];
let detections: Detection[] = [];
let tracks: Track[] = [];
let tasks: Task[] = [];
let truths: Truth[] = [];
let may_control = false, is_live = true, time_s = 0, states = "", statuses = 0;
const counted = new Map<string, number>();

const tell = (text: string): void => { notice.textContent = text; };
const globe = new Globe(by_id("globe"), (name) => choose(name), tell);
const frame = new FrameView(by_id<HTMLCanvasElement>("frame"), by_id("frame-note"));
const rate_chart = new Chart(by_id("chart-rate"), "simulated seconds per second", "seconds since this page was opened", false);
const found_chart = new Chart(by_id("chart-detections"), "detections of a frame", "simulation time, seconds", true);

by_id("legend").innerHTML = [["object", "objects"], ["alive", "sensor, works"], ["awaited", "sensor, the clock waits for it"],
  ["lost", "sensor, lost"], ["detection", "detections"], ["track", "tracks"], ["cue", "cues"]]
  .map(([key, text]) => `<span><i style="background:${palette[key as keyof typeof palette]}"></i>${text}</span>`).join("");

const state_of = (name: string): string => status?.nodes.find((n) => n.name === name)?.state ?? "alive";

function choose(name: string): void {
  sensor_list.value = name;
  globe.select(name);
  show_frame();
  globe.set_sensors(sensors, state_of);
}

function show_frame(): void {
  frame.show(sensors.find((s) => s.name === sensor_list.value), detections, truth.checked ? truths : [], Number(stretch.value));
}

function show_time(): void {
  const utc = run?.start_utc_ms != null ? new Date(run.start_utc_ms + 1e3 * time_s).toISOString().slice(0, 19).replace("T", " ") + " UTC" : "";
  by_id("utc").textContent = `${utc} ${time_s.toFixed(1)} s`;
  by_id("viewing").hidden = is_live;
  live.setAttribute("aria-pressed", String(is_live));
}

function take_sensors(list: Sensor[]): void {
  sensors = list;
  const names = list.map((s) => s.name);
  if (names.join() !== [...sensor_list.options].map((o) => o.value).join()) {
    const chosen = sensor_list.value;
    sensor_list.replaceChildren(...names.map((n) => new Option(n, n)));
    if (names.includes(chosen)) sensor_list.value = chosen;
    globe.select(sensor_list.value);
  }
  for (const s of list) {
    if (!is_live || counted.get(s.name) === s.frame) continue;
    counted.set(s.name, s.frame);
    found_chart.add(s.end_s, s.detections);
  }
  globe.set_sensors(sensors, state_of);
  show_frame();
}

function take_status(news: Status): void {
  status = news;
  ++statuses;
  const phase = by_id("phase");
  phase.textContent = news.paused && news.phase === "running" ? "paused" : news.phase;
  phase.dataset.phase = phase.textContent;
  by_id("pace").textContent = `tick ${news.settled_tick} of ${news.last_tick}, ${news.rate.toFixed(1)} times real time`;
  const notes = [];
  if (news.cause) notes.push(`Failed: ${news.cause}.`);
  if (news.missing.length) notes.push(`Missing: ${news.missing.join(", ")}.`);
  if (news.holding.length) notes.push(`The clock waits for ${news.holding.join(", ")}.`);
  if (news.overruns) notes.push(`${news.overruns} tick${news.overruns === 1 ? "" : "s"} late, at most ${news.worst_lag_s.toFixed(2)} s.`);
  by_id("run-note").textContent = notes.join(" ");
  show_nodes(by_id("health"), news);
  rate_chart.add(performance.now() / 1e3, news.rate);
  pause.textContent = news.paused ? "Go on" : "Pause";
  const running = news.phase === "running";
  speed.show(news.pace);
  for (const button of [pause, step, step_ticks, speed_list]) button.disabled = !may_control || !running;
  step.disabled ||= !news.paused;
  past.min = String(news.past.from_s);
  past.max = String(Math.max(news.past.from_s + 1e-3, news.past.to_s));
  past.disabled = news.past.states < 2;
  if (is_live) { past.value = past.max; if (globe.objects === 0) { time_s = news.time_s; show_time(); } }
  past.setAttribute("aria-valuetext", `${Number(past.value).toFixed(0)} seconds`);
  const next = news.nodes.map((n) => n.state).join();
  if (next !== states) { states = next; globe.set_sensors(sensors, state_of); }
}

function heard(message: Message): void {
  switch (message.type) {
    case "welcome":
      may_control = message.may_control;
      if (!may_control) pause.title = step.title = speed_list.title = "needs the operator's token";
      by_id("truth-switch").hidden = !message.sees_truth;
      break;
    case "run": run = message; show_time(); break;
    case "status": take_status(message); break;
    case "roster": globe.set_roster(message.objects); break;
    case "objects": time_s = message.time_s; globe.set_objects(message); show_time(); break;
    case "sensors": take_sensors(message.sensors); break;
    case "detections": detections = message.detections; globe.set_detections(detections); show_frame(); break;
    case "truth": truths = message.truths; show_frame(); break;
    case "tracks": tracks = message.tracks; globe.set_tracks(tracks); show_tracks(by_id("tracks"), tracks, tasks, time_s); break;
    case "tasks": tasks = message.tasks; globe.set_tasks(tasks, time_s); show_tracks(by_id("tracks"), tracks, tasks, time_s); break;
    case "past": time_s = message.time_s; show_time(); break;
    case "notice": case "refused": tell(message.text); break;
  }
}

const connection = new Connection(heard, (connected) => {
  if (connected) { tell(""); if (!is_live) go_live(); return; }
  const phase = by_id("phase");
  phase.textContent = phase.dataset.phase = "not connected";
});

function go_live(): void {
  is_live = true;
  past.value = past.max;
  connection.send({ do: "live" });
  show_time();
}

function look_at(seconds: number): void {
  is_live = false;
  connection.send({ do: "past", time_s: seconds });
  show_time();
}

const toggle = (): void => connection.send(status?.paused ? { do: "go-on" } : { do: "pause" });
const do_step = (): void => connection.send({ do: "step", ticks: Math.max(1, Math.floor(Number(step_ticks.value) || 1)) });
const move = (by: number): void => {
  past.value = String(Number(past.value) + (by * (Number(past.max) - Number(past.min))) / 50);
  look_at(Number(past.value));
};
const next_sensor = (by: number): void => {
  const count = sensor_list.options.length;
  if (count) choose(sensor_list.options[(sensor_list.selectedIndex + by + count) % count]!.value);
};

const speed = new Speed(speed_list, (factor) => connection.send({ do: "pace", factor }));

pause.onclick = toggle;
step.onclick = do_step;
live.onclick = go_live;
past.oninput = () => look_at(Number(past.value));
sensor_list.onchange = () => choose(sensor_list.value);
stretch.onchange = truth.onchange = show_frame;
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT|TEXTAREA/.test((event.target as Element).tagName)) return;
  const act: Record<string, () => void> = {
    " ": () => { if (!pause.disabled) toggle(); }, ".": () => { if (!step.disabled) do_step(); }, ",": () => move(-1), ";": () => move(1),
    "-": () => speed.move(-1), "+": () => speed.move(1), t: () => { if (!by_id("truth-switch").hidden) truth.click(); },
    l: go_live, n: () => next_sensor(1), p: () => next_sensor(-1), h: () => globe.whole(),
  };
  if (event.key === " " && /BUTTON|SUMMARY/.test((event.target as Element).tagName)) return; // presses that
  if (act[event.key]) { event.preventDefault(); act[event.key]!(); }
});

// For tests and for whoever measures.
Object.assign(window, {
  dmise: {
    pictures: () => globe.pictures, named: () => globe.named, scenes: () => globe.scenes, objects: () => globe.objects, statuses: () => statuses, time_s: () => time_s,
    screen_of: (sensor: string) => globe.screen_of(sensor), pace: () => status?.pace, frame: (sensor: string) => sensors.find((s) => s.name === sensor)?.frame,
    draw: (on: boolean) => { globe.drawing = globe.widget.useDefaultRenderLoop = on; },
  },
});
