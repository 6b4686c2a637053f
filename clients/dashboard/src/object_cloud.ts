// All objects as points in one draw call. Between two states the graphics processor interpolates, so that a picture costs no
// work for each object; Cesium's PointPrimitiveCollection would write every point again for every picture.
import * as Cesium from "@cesium/engine";

// What Cesium draws with is exported, and has no types; the version is pinned.
// eslint-disable-next-line @typescript-eslint/no-explicit-any
const gl = Cesium as any;

const vertex_shader = `
in vec3 before_km;
in vec3 after_km;
uniform float u_part;
uniform float u_pixels;
out float v_shown;
void main() {
  vec3 place = mix(before_km, after_km, u_part) * 1000.0;
  v_shown = dot(after_km, after_km) > 1.0 ? 1.0 : 0.0;
  gl_Position = czm_modelViewProjection * vec4(place, 1.0);
  gl_PointSize = u_pixels;
}`;

const fragment_shader = `
uniform vec4 u_colour;
in float v_shown;
void main() {
  if (v_shown < 0.5) discard;
  out_FragColor = u_colour;
}`;

const longest_step_s = 600; // beyond it, a straight line is no path

export class ObjectCloud {
  private before: Float32Array = new Float32Array();
  private after: Float32Array = new Float32Array();
  private time_s = 0;
  private arrived_ms = 0;
  private spacing_ms = 100;
  private jump = true;
  private dirty = false;
  private buffers: any[] = []; // eslint-disable-line @typescript-eslint/no-explicit-any
  private command: any = null; // eslint-disable-line @typescript-eslint/no-explicit-any
  private readonly colour: Cesium.Color;

  /** `pixels`: size of a point in the drawn picture. */
  constructor(colour: string, private readonly pixels: () => number) {
    this.colour = Cesium.Color.fromCssColorString(colour);
  }

  get count(): number { return this.after.length / 3; }

  set(position_km: Float32Array, time_s: number): void {
    const now = performance.now();
    const same = position_km.length === this.after.length && time_s > this.time_s && time_s - this.time_s < longest_step_s;
    this.before = same ? this.shown() : position_km;
    this.spacing_ms = Math.min(2000, Math.max(50, now - this.arrived_ms));
    this.jump = !same;
    this.arrived_ms = now;
    this.after = position_km;
    this.time_s = time_s;
    this.dirty = true;
  }

  private part(): number {
    return this.jump ? 1 : Math.min(1, (performance.now() - this.arrived_ms) / this.spacing_ms);
  }

  /** Positions as they are on the screen now [km]. */
  shown(): Float32Array {
    const part = this.part();
    if (part >= 1) return this.after;
    const shown = new Float32Array(this.after.length);
    for (let i = 0; i < shown.length; ++i) shown[i] = this.before[i]! + part * (this.after[i]! - this.before[i]!);
    return shown;
  }

  get moves(): boolean { return this.part() < 1 || this.dirty; }

  // Called by the scene for each picture.
  update(frame: { context: unknown; commandList: unknown[]; passes: { render: boolean } }): void {
    if (!frame.passes.render || this.count === 0) return;
    if (this.dirty) this.upload(frame.context);
    frame.commandList.push(this.command);
  }

  private upload(context: unknown): void {
    this.dirty = false;
    if (this.buffers[0]?.sizeInBytes === this.after.byteLength) {
      this.buffers[0].copyFromArrayView(this.before);
      this.buffers[1].copyFromArrayView(this.after);
      return;
    }
    this.release();
    this.buffers = [this.before, this.after].map((typedArray) =>
      gl.Buffer.createVertexBuffer({ context, typedArray, usage: gl.BufferUsage.DYNAMIC_DRAW }));
    const attributes = this.buffers.map((vertexBuffer, index) => ({
      index, vertexBuffer, componentsPerAttribute: 3, componentDatatype: Cesium.ComponentDatatype.FLOAT,
    }));
    this.command = new gl.DrawCommand({
      vertexArray: new gl.VertexArray({ context, attributes }),
      shaderProgram: gl.ShaderProgram.fromCache({
        context, vertexShaderSource: vertex_shader, fragmentShaderSource: fragment_shader,
        attributeLocations: { before_km: 0, after_km: 1 },
      }),
      primitiveType: Cesium.PrimitiveType.POINTS,
      renderState: gl.RenderState.fromCache({ depthTest: { enabled: true }, depthMask: false }),
      uniformMap: { u_part: () => this.part(), u_pixels: this.pixels, u_colour: () => this.colour },
      modelMatrix: Cesium.Matrix4.IDENTITY,
      boundingVolume: new Cesium.BoundingSphere(Cesium.Cartesian3.ZERO, 5e7),
      pass: gl.Pass.OPAQUE,
      owner: this,
    });
  }

  private release(): void {
    if (!this.command) return;
    this.command.vertexArray.destroy();
    this.command.shaderProgram.destroy();
    this.command = null;
    this.buffers = [];
  }

  isDestroyed(): boolean { return false; }
  destroy(): void { this.release(); }
}
