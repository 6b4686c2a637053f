// What the Earth hides from a place.
import * as Cesium from "@cesium/engine";

const { x: equator_m, z: pole_m } = Cesium.Ellipsoid.WGS84.radii;

export class Horizon {
  // In units in which the Earth is the unit sphere.
  private readonly x: number;
  private readonly y: number;
  private readonly z: number;
  private readonly tangent2: number; // square of the distance to the horizon

  constructor(eye_m: Cesium.Cartesian3) {
    this.x = eye_m.x / equator_m;
    this.y = eye_m.y / equator_m;
    this.z = eye_m.z / pole_m;
    this.tangent2 = this.x * this.x + this.y * this.y + this.z * this.z - 1;
  }

  /** Whether the Earth is before a place [m]. */
  hides(x_m: number, y_m: number, z_m: number): boolean {
    const dx = x_m / equator_m - this.x, dy = y_m / equator_m - this.y, dz = z_m / pole_m - this.z;
    const towards = -(dx * this.x + dy * this.y + dz * this.z);
    return towards > this.tangent2 && towards * towards > this.tangent2 * (dx * dx + dy * dy + dz * dz);
  }
}
