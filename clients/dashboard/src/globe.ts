// The globe: objects, sensors with their fields of view, detections, tracks and cues.
import * as Cesium from "@cesium/engine";
import type { Detection, Objects, Sensor, Task, Track } from "./messages";
import { Horizon } from "./horizon";
import { keep_apart } from "./labels";
import { LineSet } from "./line_set";
import { ObjectCloud } from "./object_cloud";
import { colour_of, palette } from "./palette";

const field_length_m = 1.5e6, detection_length_m = 3e6;
const most_lines = 2000;
const scene_interval_ms = 200; // between pictures of the globe with what stands on it; a camera that is moved does not wait
const sun_step_ms = 120_000; // simulated time: half a degree of the terminator
const most_named = 30, most_labels = 40; // sensors, tracks with names

const metres = (km: ArrayLike<number>, i = 0): Cesium.Cartesian3 =>
  new Cesium.Cartesian3(1e3 * km[i]!, 1e3 * km[i + 1]!, 1e3 * km[i + 2]!);
const along = (from: Cesium.Cartesian3, direction: ArrayLike<number>, length_m: number, i = 0): Cesium.Cartesian3 =>
  new Cesium.Cartesian3(from.x + length_m * direction[i]!, from.y + length_m * direction[i + 1]!, from.z + length_m * direction[i + 2]!);
const colour = (css: string, alpha = 1): Cesium.Color => Cesium.Color.fromCssColorString(css).withAlpha(alpha);

export class Globe {
  readonly widget: Cesium.CesiumWidget;
  private readonly cloud: ObjectCloud;
  private readonly sensor_points = new Cesium.PointPrimitiveCollection();
  private readonly labels: Cesium.LabelCollection;
  private readonly fields = new LineSet();
  private readonly detections = new LineSet();
  private readonly track_points = new Cesium.PointPrimitiveCollection();
  private readonly track_labels: Cesium.LabelCollection;
  private readonly cues = new LineSet();
  private roster: [number, string][] = [];
  private selected = "";
  private started = false;
  pictures = 0; // how many of the objects were drawn
  scenes = 0; // how many of the globe were drawn
  named: { left: number; top: number; right: number; bottom: number }[] = []; // where names stand, in pixels of the canvas
  private scene_ms = 0;
  private scene_wanted = false;
  private sun_ms = 0;

  constructor(container: Element, private readonly pick_sensor: (name: string) => void, private readonly tell: (text: string) => void) {
    this.widget = new Cesium.CesiumWidget(container, {
      baseLayer: Cesium.ImageryLayer.fromProviderAsync(
        Cesium.TileMapServiceImageryProvider.fromUrl(Cesium.buildModuleUrl("Assets/Textures/NaturalEarthII"))),
      skyBox: false, skyAtmosphere: false, scene3DOnly: true, msaaSamples: 1, orderIndependentTranslucency: false, requestRenderMode: true,
      maximumRenderTimeChange: Infinity, showRenderLoopErrors: false, creditContainer: document.createElement("div"),
    });
    const scene = this.widget.scene;
    scene.backgroundColor = colour("#05070a");
    scene.globe.enableLighting = true;
    scene.globe.showGroundAtmosphere = false;
    scene.fog.enabled = false;
    scene.globe.maximumScreenSpaceError = 3; // pixels of the texture: it has few
    if (scene.sun) scene.sun.show = false;
    if (scene.moon) scene.moon.show = false;
    scene.screenSpaceCameraController.minimumZoomDistance = 1e4;
    this.labels = new Cesium.LabelCollection({ scene });
    this.track_labels = new Cesium.LabelCollection({ scene });
    for (const part of [this.fields, this.detections, this.cues, this.track_points, this.sensor_points,
      this.labels, this.track_labels]) scene.primitives.add(part);
    this.cloud = new ObjectCloud(this.widget.container, palette.object);
    scene.preRender.addEventListener(() => { this.named = keep_apart(scene, [this.labels, this.track_labels], this.sensor_points); });
    scene.postRender.addEventListener(() => { ++this.scenes; this.draw(); });
    this.whole();
    const canvas = this.widget.canvas;
    canvas.setAttribute("aria-hidden", "true"); // the tables tell the same
    canvas.removeAttribute("tabindex");
    new Cesium.ScreenSpaceEventHandler(canvas).setInputAction(
      (click: { position: Cesium.Cartesian2 }) => this.click(click.position), Cesium.ScreenSpaceEventType.LEFT_CLICK);
    const next = (now: number): void => {
      if (this.drawing && this.cloud.moves) this.draw();
      if (this.scene_wanted && now - this.scene_ms > scene_interval_ms) {
        [this.scene_wanted, this.scene_ms] = [false, now];
        scene.requestRender();
      }
      requestAnimationFrame(next);
    };
    requestAnimationFrame(next);
  }

  private draw(): void {
    ++this.pictures;
    this.cloud.draw(this.widget.camera);
  }

  /** Whether objects are drawn as they move. */
  drawing = true;

  whole(): void {
    this.widget.camera.setView({ destination: Cesium.Cartesian3.fromDegrees(-84, 25, 2.6e7) });
    this.redraw();
  }

  set_roster(roster: [number, string][]): void { this.roster = roster; }

  set_objects(objects: Objects): void {
    this.cloud.set(objects.position_km, objects.time_s);
    if (Math.abs(objects.utc_ms - this.sun_ms) < sun_step_ms || objects.utc_ms <= 0) return;
    this.sun_ms = objects.utc_ms;
    this.widget.clock.currentTime = Cesium.JulianDate.fromDate(new Date(objects.utc_ms));
    this.redraw();
  }

  get objects(): number { return this.cloud.count; }

  set_sensors(sensors: Sensor[], state_of: (name: string) => string): void {
    this.sensor_points.removeAll();
    this.labels.removeAll();
    this.fields.clear();
    for (const sensor of sensors) {
      const place = metres(sensor.position_km);
      const state = state_of(sensor.name);
      const shown = sensor.name === this.selected;
      this.sensor_points.add({
        position: place, pixelSize: shown ? 13 : 9, color: colour(colour_of(state)), outlineColor: colour(palette.ground),
        outlineWidth: 2, id: { sensor: sensor.name },
      });
      if (shown || sensors.length <= most_named)
        this.labels.add({
          position: place, text: state === "alive" ? sensor.name : `${sensor.name} (${state})`, font: "13px sans-serif",
          fillColor: colour(palette.text), outlineColor: colour(palette.ground), outlineWidth: 3,
          style: Cesium.LabelStyle.FILL_AND_OUTLINE,
        });
      this.add_field(sensor, place, colour_of(state), shown ? 0.95 : 0.5);
    }
    this.start(sensors);
    this.redraw();
  }

  /** The border of the field at some distance, and its corners from the sensor. */
  private add_field(sensor: Sensor, place: Cesium.Cartesian3, css: string, alpha: number): void {
    const border: Cesium.Cartesian3[] = [];
    for (let i = 0; i < sensor.field.length; i += 3) border.push(along(place, sensor.field, field_length_m, i));
    if (border.length < 4) return;
    this.fields.add([...border, border[0]!], colour(css, alpha));
    for (let corner = 0; corner < 4; ++corner)
      this.fields.add([place, border[(corner * border.length) / 4]!], colour(css, alpha / 2));
  }

  private start(sensors: Sensor[]): void {
    if (this.started || !sensors[0]) return;
    this.started = true;
    const place = Cesium.Cartographic.fromCartesian(metres(sensors[0].position_km));
    this.widget.camera.setView({ destination: Cesium.Cartesian3.fromRadians(place.longitude, 0.6 * place.latitude, 1.6e7) });
  }

  set_detections(detections: Detection[]): void {
    this.detections.clear();
    for (const detection of detections.slice(0, most_lines)) {
      if (!detection.from_km || !detection.direction) continue;
      const from = metres(detection.from_km);
      this.detections.add([from, along(from, detection.direction, detection_length_m)], colour(palette.detection, 0.9));
    }
    this.redraw();
  }

  set_tracks(tracks: Track[]): void {
    this.track_points.removeAll();
    this.track_labels.removeAll();
    for (const [i, track] of tracks.entries()) {
      const place = metres(track.position_km);
      this.track_points.add({
        position: place, pixelSize: track.status === "confirmed" ? 8 : 5, color: Cesium.Color.TRANSPARENT,
        outlineColor: colour(palette.track), outlineWidth: 2, id: { track: track.id },
      });
      if (i < most_labels)
        this.track_labels.add({
          position: place, text: track.name || `track ${track.id}`, font: "12px sans-serif", fillColor: colour(palette.track),
          outlineColor: colour(palette.ground), outlineWidth: 3, style: Cesium.LabelStyle.FILL_AND_OUTLINE,
        });
    }
    this.redraw();
  }

  set_tasks(tasks: Task[], time_s: number): void {
    this.cues.clear();
    for (const task of tasks) {
      if (task.end_s < time_s || task.path_km.length < 6) continue;
      const positions: Cesium.Cartesian3[] = [];
      for (let i = 0; i + 2 < task.path_km.length; i += 3) positions.push(metres(task.path_km, i));
      this.cues.add(positions, colour(palette.cue, 0.95));
    }
    this.redraw();
  }

  /** Where a sensor is on the screen, in pixels of the canvas; null: behind it, or unknown. */
  screen_of(sensor: string): { x: number; y: number } | null {
    for (let i = 0; i < this.sensor_points.length; ++i) {
      const point = this.sensor_points.get(i);
      if ((point.id as { sensor: string }).sensor !== sensor) continue;
      const at = Cesium.SceneTransforms.worldToWindowCoordinates(this.widget.scene, point.position);
      return at ? { x: at.x, y: at.y } : null;
    }
    return null;
  }

  select(sensor: string): void { this.selected = sensor; }

  redraw(): void { this.scene_wanted = true; }

  private click(at: Cesium.Cartesian2): void {
    const sensor = this.nearest(this.sensor_points, at) as { sensor: string } | undefined;
    if (sensor) return this.pick_sensor(sensor.sensor);
    const track = this.nearest(this.track_points, at) as { track: number } | undefined;
    if (track) return this.tell(`track ${track.track}`);
    const object = this.object_at(at);
    if (object >= 0) {
      const [number, name] = this.roster[object] ?? [0, ""];
      this.tell(`object ${name || "without a name"}${number ? `, number ${number}` : ""}`);
    }
  }

  /** The point nearest to a place on the screen, before the Earth: found without drawing, which may take long. */
  private nearest(points: Cesium.PointPrimitiveCollection, at: Cesium.Cartesian2): unknown {
    const horizon = new Horizon(this.widget.camera.positionWC);
    let best: unknown, least = 10;
    for (let i = 0; i < points.length; ++i) {
      const { position, id } = points.get(i);
      const place = Cesium.SceneTransforms.worldToWindowCoordinates(this.widget.scene, position);
      if (!place || horizon.hides(position.x, position.y, position.z)) continue;
      const off = Cesium.Cartesian2.distance(place, at);
      if (off < least) [least, best] = [off, id];
    }
    return best;
  }

  /** The nearest object within 8 pixels of a place on the screen, before the Earth; -1: none. */
  private object_at(at: Cesium.Cartesian2): number {
    const ray = this.widget.camera.getPickRay(at);
    if (!ray) return -1;
    const ground = Cesium.IntersectionTests.rayEllipsoid(ray, Cesium.Ellipsoid.WGS84)?.start ?? Infinity;
    const frustum = this.widget.camera.frustum as Cesium.PerspectiveFrustum;
    const pixel_rad = (frustum.fovy ?? 1) / this.widget.canvas.clientHeight;
    const shown = this.cloud.shown();
    let best = -1, least = 8 * pixel_rad;
    for (let i = 0; i < shown.length; i += 3) {
      const to = Cesium.Cartesian3.subtract(metres(shown, i), ray.origin, new Cesium.Cartesian3());
      const distance = Cesium.Cartesian3.dot(to, ray.direction);
      if (distance <= 0 || distance > ground) continue;
      const off = Cesium.Cartesian3.magnitude(Cesium.Cartesian3.cross(to, ray.direction, new Cesium.Cartesian3())) / distance;
      if (off < least) [least, best] = [off, i / 3];
    }
    return best;
  }
}
