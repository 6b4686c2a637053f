// Lines of one pixel in one draw call: fields of view, lines of sight, paths. Cesium's PolylineCollection takes 0.15 s of a
// processor to replace the fields of 100 sensors, this 1 ms.
import * as Cesium from "@cesium/engine";

// eslint-disable-next-line @typescript-eslint/no-explicit-any
const gl = Cesium as any;

const vertex_shader = `
in vec3 place;
in vec4 colour;
out vec4 v_colour;
void main() {
  gl_Position = czm_modelViewProjection * vec4(place, 1.0);
  v_colour = colour;
}`;

const fragment_shader = `
in vec4 v_colour;
void main() { out_FragColor = v_colour; }`;

export class LineSet {
  private places: number[] = [];
  private colours: number[] = [];
  private dirty = false;
  private command: any = null; // eslint-disable-line @typescript-eslint/no-explicit-any

  clear(): void { this.places = []; this.colours = []; this.dirty = true; }

  /** A line through points, metres in the Earth's frame. */
  add(points: Cesium.Cartesian3[], colour: Cesium.Color): void {
    const rgba = colour.toBytes();
    for (let i = 1; i < points.length; ++i)
      for (const p of [points[i - 1]!, points[i]!]) {
        this.places.push(p.x, p.y, p.z);
        this.colours.push(...rgba);
      }
    this.dirty = true;
  }

  // Called by the scene for each picture.
  update(frame: { context: unknown; commandList: unknown[]; passes: { render: boolean } }): void {
    if (!frame.passes.render) return;
    if (this.dirty) this.upload(frame.context);
    if (this.command) frame.commandList.push(this.command);
  }

  private upload(context: unknown): void {
    this.dirty = false;
    this.release();
    if (this.places.length === 0) return;
    const buffer = (typedArray: ArrayBufferView): unknown =>
      gl.Buffer.createVertexBuffer({ context, typedArray, usage: gl.BufferUsage.STATIC_DRAW });
    this.command = new gl.DrawCommand({
      vertexArray: new gl.VertexArray({ context, attributes: [
        { index: 0, vertexBuffer: buffer(new Float32Array(this.places)), componentsPerAttribute: 3, componentDatatype: Cesium.ComponentDatatype.FLOAT },
        { index: 1, vertexBuffer: buffer(new Uint8Array(this.colours)), componentsPerAttribute: 4,
          componentDatatype: Cesium.ComponentDatatype.UNSIGNED_BYTE, normalize: true },
      ] }),
      shaderProgram: gl.ShaderProgram.fromCache({
        context, vertexShaderSource: vertex_shader, fragmentShaderSource: fragment_shader, attributeLocations: { place: 0, colour: 1 },
      }),
      primitiveType: Cesium.PrimitiveType.LINES,
      renderState: gl.RenderState.fromCache({ depthTest: { enabled: true }, depthMask: false, blending: gl.BlendingState.ALPHA_BLEND }),
      modelMatrix: Cesium.Matrix4.IDENTITY,
      boundingVolume: new Cesium.BoundingSphere(Cesium.Cartesian3.ZERO, 5e7),
      pass: gl.Pass.OPAQUE,
      owner: this,
    });
  }

  private release(): void {
    if (!this.command) return;
    this.command.vertexArray.destroy(); // with its buffers
    this.command.shaderProgram.destroy(); // a reference; the scene's cache keeps it for the next
    this.command = null;
  }

  isDestroyed(): boolean { return false; }
  destroy(): void { this.release(); }
}
