// Builds the dashboard into DMISE_DASHBOARD_OUT (default: dist): a page, its script and style, and what CesiumJS loads
// at run time: its workers and the textures that this page uses.
import { cpSync, mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { defineConfig } from "vite";

const out = resolve(process.env.DMISE_DASHBOARD_OUT ?? "dist");
const engine = resolve("node_modules/@cesium/engine");

const cesium_files = {
  name: "cesium-files",
  closeBundle() {
    for (const [from, to] of [
      ["Build/Workers", "Workers"],
      ["Source/Assets/Textures/NaturalEarthII", "Assets/Textures/NaturalEarthII"],
      ["Source/Assets/Images", "Assets/Images"],
      ["Source/Assets/IAU2006_XYS", "Assets/IAU2006_XYS"],
      ["Source/Assets/approximateTerrainHeights.json", "Assets/approximateTerrainHeights.json"],
      ["LICENSE.md", "LICENSE.md"],
    ]) {
      const target = join(out, "cesium", to);
      mkdirSync(join(target, ".."), { recursive: true });
      cpSync(join(engine, from), target, { recursive: true });
    }
  },
};

export default defineConfig({
  define: { CESIUM_BASE_URL: JSON.stringify("/cesium/") },
  plugins: [cesium_files],
  build: { outDir: out, emptyOutDir: true, minify: !process.env.DMISE_DASHBOARD_DEBUG, chunkSizeWarningLimit: 8000, reportCompressedSize: false },
});
