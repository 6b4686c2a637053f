// Keeps names of neighbours apart: each stands at the first free of some places beside its point, and is left out where none is.
import * as Cesium from "@cesium/engine";
import { Horizon } from "./horizon";

interface Box { left: number; top: number; right: number; bottom: number }

const height_px = 16, character_px = 7.2, gap_px = 11, point_px = 8; // half of a point's size
const lines_px = [0, -16, 16, -32, 32]; // from the middle of the point
const meets = (a: Box, b: Box): boolean => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/** Places the labels of all collections, those of the first collections first, beside each other and the points; returns where. */
export function keep_apart(scene: Cesium.Scene, collections: Cesium.LabelCollection[], points: Cesium.PointPrimitiveCollection): Box[] {
  const horizon = new Horizon(scene.camera.positionWC), taken: Box[] = [], named: Box[] = [];
  for (let i = 0; i < points.length; ++i) {
    const { x, y, z } = points.get(i).position;
    const at = horizon.hides(x, y, z) ? undefined : Cesium.SceneTransforms.worldToWindowCoordinates(scene, points.get(i).position);
    if (at) taken.push({ left: at.x - point_px, top: at.y - point_px, right: at.x + point_px, bottom: at.y + point_px });
  }
  for (const labels of collections)
    for (let i = 0; i < labels.length; ++i) {
      const label = labels.get(i), { x, y, z } = label.position;
      const at = horizon.hides(x, y, z) ? undefined : Cesium.SceneTransforms.worldToWindowCoordinates(scene, label.position);
      label.show = false;
      if (!at) continue;
      const width_px = character_px * label.text.length + 6;
      for (const [k, line] of [...lines_px, ...lines_px].entries()) {
        const to_right = k < lines_px.length;
        const left = to_right ? at.x + gap_px : at.x - gap_px - width_px, top = at.y + line - height_px / 2;
        const box = { left, top, right: left + width_px, bottom: top + height_px };
        if (taken.some((other) => meets(box, other))) continue;
        taken.push(box);
        named.push(box);
        label.horizontalOrigin = to_right ? Cesium.HorizontalOrigin.LEFT : Cesium.HorizontalOrigin.RIGHT;
        label.verticalOrigin = Cesium.VerticalOrigin.CENTER;
        label.pixelOffset = new Cesium.Cartesian2(to_right ? gap_px : -gap_px, line);
        label.show = true;
        break;
      }
    }
  return named;
}
