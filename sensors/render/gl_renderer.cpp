#include "sensors/render/gl_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "core/base/error.h"
#include "sensors/render/gl/gl.h"
#include "sensors/render/gl/gl_context.h"
#include "sensors/render/gl/gl_program.h"
#include "sensors/render/gl/gl_textures.h"
#include "sensors/render/renderer.h"
#include "sensors/render/shaders.h"
#include "sensors/render/tile_mesh.h"

namespace dmise {
namespace {

/// A rectangle of pixels of a tile.
struct TileBox {
  int left = 0, top = 0, columns = 0, rows = 0;
};

/// Adds the mean of each pixel's samples to the tile: of up to three bands from `first_band` on
/// and, if `with_coverage`, of the fourth channel to the coverage. `samples`: box.rows x
/// oversampling rows of box.columns x oversampling samples of four floats.
void add_box_means(const float* samples, const TileBox& box, int oversampling,
                   std::size_t first_band, bool with_coverage, Tile& tile) {
  using Four = float __attribute__((vector_size(16)));
  const std::size_t n = std::size_t(oversampling);
  const std::size_t row_samples = std::size_t(box.columns) * n;
  const std::size_t bands = std::size_t(tile.bands);
  const std::size_t channels = std::min<std::size_t>(3, bands - first_band);
  const float share = 1.0f / float(n * n);
  std::vector<Four> sums(std::size_t(box.columns));
  for (int y = 0; y < box.rows; ++y) {
    std::fill(sums.begin(), sums.end(), Four{});
    for (std::size_t sy = 0; sy < n; ++sy) {
      const float* row = samples + 4 * row_samples * (std::size_t(y) * n + sy);
      for (std::size_t x = 0; x < sums.size(); ++x) {
        Four sum = sums[x];
        for (std::size_t sx = 0; sx < n; ++sx) {
          Four sample;
          __builtin_memcpy(&sample, row + 4 * (x * n + sx), sizeof sample);
          sum += sample;
        }
        sums[x] = sum;
      }
    }
    const std::size_t first =
        std::size_t(box.top + y) * std::size_t(tile.columns) + std::size_t(box.left);
    for (std::size_t x = 0; x < sums.size(); ++x) {
      const Four mean = sums[x] * share;
      for (std::size_t k = 0; k < channels; ++k)
        tile.radiance[(first + x) * bands + first_band + k] += mean[k];
      if (with_coverage) tile.coverage[first + x] += mean[3];
    }
  }
}

/// Samples of one piece per axis: 4 MB of colour.
constexpr int piece_samples = 512;

/// From this number of radii on an object is seen along parallel directions.
constexpr double parallel_from = 1e4;

class GlRenderer final : public Renderer {
 public:
  GlRenderer() : context_(open_gl()), gl_(load_gl(*context_)), textures_(gl_) {
    make_target();
    plain_ = make_stage(nullptr);
    samples_.resize(std::size_t(piece_samples) * piece_samples * 4);
  }

  std::string description() const override { return description_of(gl_, *context_); }

  Tile draw(const TileScene& scene) override {
    check(scene);
    context_->make_current();
    Tile tile{.columns = scene.camera.columns,
              .rows = scene.camera.rows,
              .bands = int(scene.bands.size())};
    const std::size_t pixels = std::size_t(tile.columns) * std::size_t(tile.rows);
    tile.radiance.assign(pixels * scene.bands.size(), 0.0f);
    tile.coverage.assign(pixels, 0.0f);
    const bool convex = is_convex(*scene.mesh);
    std::optional<FacetShadow> viewer;
    if (!convex && views_are_parallel(scene))
      viewer.emplace(*scene.mesh, unit(scene.camera_from_body.inverse() * -scene.object_m));
    bool first = true;
    for (const auto& source : scene.sources) {
      const LitPieces lit =
          lit_pieces(*scene.mesh, source.to_source, convex, viewer ? &*viewer : nullptr);
      for (std::size_t band = 0; band < scene.bands.size(); band += 3)
        draw_pass(scene, source, tile_mesh(scene, source, lit, band, first), band,
                  first && band == 0, tile);
      first = false;
    }
    return tile;
  }

 private:
  /// Whether what is visible from the camera is what is visible from afar: perspective moves an
  /// edge in front of what it hides by less than `min_seen_px`.
  static bool views_are_parallel(const TileScene& scene) {
    constexpr double min_seen_px = 0.02;
    const double ratio = radius_m(*scene.mesh) / norm(scene.object_m);
    return ratio * parallel_from < 1.0 || 2.0 * ratio * ratio * scene.camera.focal_px < min_seen_px;
  }

  static void check(const TileScene& scene) {
    const auto& camera = scene.camera;
    if (camera.columns < 1 || camera.rows < 1 || camera.columns > 16384 || camera.rows > 16384)
      throw Error("tile must have from 1 to 16384 pixels a side");
    if (scene.bands.empty() || scene.bands.size() > 16)
      throw Error("tile must have from 1 to 16 bands");
    if (scene.oversampling < 1 || scene.oversampling > 64)
      throw Error("oversampling must be from 1 to 64");
    if (scene.sources.empty()) throw Error("tile needs a source of light");
    check_outside(*scene.mesh, scene.camera_from_body, scene.object_m);
  }

  /// A program with its input buffers.
  struct Stage {
    unsigned program = 0, arrays = 0, buffers[3] = {0, 0, 0};  // vertices, indices, textures
    int piece = -1, source = -1, weights = -1;
  };

  void make_target() {
    unsigned frame = 0, buffers[2];
    gl_.GenFramebuffers(1, &frame);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl_.GenRenderbuffers(2, buffers);
    constexpr unsigned format[2] = {GL_RGBA32F, GL_DEPTH_COMPONENT32F};
    constexpr unsigned place[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
    for (int i = 0; i < 2; ++i) {
      gl_.BindRenderbuffer(GL_RENDERBUFFER, buffers[i]);
      gl_.RenderbufferStorage(GL_RENDERBUFFER, format[i], piece_samples, piece_samples);
      gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, place[i], GL_RENDERBUFFER, buffers[i]);
    }
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error("OpenGL cannot draw into RGBA32F");
    // Depth runs from 1 at the nearest point to 0: floats are finest where perspective is coarsest.
    gl_.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_GREATER);
    // Snapping of corners moves a plane by 1/256 of a sample's slope; the offset is larger.
    gl_.PolygonOffset(-0.05f, -4.0f);
    gl_.ClearDepth(0.0);
    gl_.ClearColor(0, 0, 0, 0);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  }

  Stage make_stage(const char* definition) {
    Stage stage;
    stage.program = link_program(gl_, vertex_shader, fragment_shader, definition);
    stage.piece = gl_.GetUniformLocation(stage.program, "piece");
    stage.source = gl_.GetUniformLocation(stage.program, "source");
    stage.weights = gl_.GetUniformLocation(stage.program, "weights");
    gl_.CreateVertexArrays(1, &stage.arrays);
    gl_.BindVertexArray(stage.arrays);
    gl_.GenBuffers(3, stage.buffers);
    gl_.BindBuffer(GL_ARRAY_BUFFER, stage.buffers[0]);
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, stage.buffers[1]);
    const auto attribute = [this](unsigned location, int floats, int stride, std::size_t offset) {
      gl_.VertexAttribPointer(location, floats, GL_FLOAT, GL_FALSE, stride,
                              reinterpret_cast<const void*>(offset));
      gl_.EnableVertexAttribArray(location);
    };
    attribute(0, 4, sizeof(TileVertex), offsetof(TileVertex, clip));
    attribute(1, 3, sizeof(TileVertex), offsetof(TileVertex, view));
    attribute(2, 3, sizeof(TileVertex), offsetof(TileVertex, normal));
    attribute(3, 4, sizeof(TileVertex), offsetof(TileVertex, diffuse));
    attribute(4, 4, sizeof(TileVertex), offsetof(TileVertex, specular));
    attribute(5, 4, sizeof(TileVertex), offsetof(TileVertex, emitted));
    if (stage.weights < 0) return stage;
    gl_.BindBuffer(GL_ARRAY_BUFFER, stage.buffers[2]);
    attribute(6, 4, sizeof(TextureVertex), offsetof(TextureVertex, place));
    attribute(7, 3, sizeof(TextureVertex), offsetof(TextureVertex, slope_u));
    attribute(8, 3, sizeof(TextureVertex), offsetof(TextureVertex, slope_v));
    return stage;
  }

  void send(unsigned buffer, const auto& values) {
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer);
    gl_.BufferData(GL_ARRAY_BUFFER, std::ptrdiff_t(values.size() * sizeof(values[0])),
                   values.data(), GL_STREAM_DRAW);
  }

  void draw_pass(const TileScene& scene, const LightSource& source, const TileMesh& mesh,
                 std::size_t first_band, bool with_coverage, Tile& tile) {
    if (!mesh.texture.empty() && textured_.program == 0) textured_ = make_stage("TEXTURED");
    const Stage& stage = mesh.texture.empty() ? plain_ : textured_;
    gl_.UseProgram(stage.program);
    gl_.BindVertexArray(stage.arrays);
    send(stage.buffers[0], mesh.vertices);
    if (!mesh.texture.empty()) send(stage.buffers[2], mesh.texture);
    const glm::vec3 to_source = glm_of(scene.camera_from_body * source.to_source);
    gl_.Uniform4f(stage.source, to_source.x, to_source.y, to_source.z, 0);
    const int step = std::max(1, piece_samples / scene.oversampling);
    for (int top = 0; top < tile.rows; top += step)
      for (int left = 0; left < tile.columns; left += step) {
        const TileBox box{left, top, std::min(step, tile.columns - left),
                          std::min(step, tile.rows - top)};
        if (!draw_piece(scene, stage, mesh, box, first_band)) continue;
        add_box_means(samples_.data(), box, scene.oversampling, first_band, with_coverage, tile);
      }
    add_specks(mesh, first_band, tile);
    if (const unsigned error = gl_.GetError(); error != GL_NO_ERROR)
      throw Error("OpenGL error " + std::to_string(error));
  }

  static void add_specks(const TileMesh& mesh, std::size_t first_band, Tile& tile) {
    const std::size_t bands = std::size_t(tile.bands);
    for (const auto& speck : mesh.specks) {
      const int x = std::clamp(int(std::lround(speck.place_px.x)), 0, tile.columns - 1);
      const int y = std::clamp(int(std::lround(speck.place_px.y)), 0, tile.rows - 1);
      float* pixel =
          &tile.radiance[(std::size_t(y) * std::size_t(tile.columns) + std::size_t(x)) * bands];
      for (int k = 0; first_band + std::size_t(k) < bands && k < 3; ++k)
        pixel[first_band + std::size_t(k)] += speck.light[k];
    }
  }

  /// Indices of the triangles in the box, sorted by material if they have pictures; underlays
  /// first.
  void choose(const TileMesh& mesh, const TileBox& box, std::size_t materials) {
    indices_.clear();
    ranges_.clear();
    const float x0 = float(box.left) - 0.5f, x1 = x0 + float(box.columns);
    const float y0 = float(box.top) - 0.5f, y1 = y0 + float(box.rows);
    by_material_.resize(mesh.material.empty() ? 1 : materials);
    const auto choose_from = [&](std::size_t first, std::size_t end, bool underlay) {
      for (auto& chosen : by_material_) chosen.clear();
      for (std::size_t t = first; t < end; ++t) {
        const auto& b = mesh.bounds[t];
        if (b.x1 >= x0 && b.x0 <= x1 && b.y1 >= y0 && b.y0 <= y1)
          by_material_[mesh.material.empty() ? 0 : mesh.material[t]].push_back(std::uint32_t(t));
      }
      for (std::size_t m = 0; m < by_material_.size(); ++m) {
        if (by_material_[m].empty()) continue;
        ranges_.push_back({m, indices_.size(), 3 * by_material_[m].size(), underlay});
        for (const std::uint32_t t : by_material_[m])
          for (std::uint32_t i = 0; i < 3; ++i) indices_.push_back(3 * t + i);
      }
    };
    choose_from(0, mesh.underlays, true);
    choose_from(mesh.underlays, mesh.bounds.size(), false);
  }

  void use_pictures(const TileScene& scene, const Stage& stage, std::size_t material,
                    std::size_t first_band) {
    const Material& m = scene.mesh->materials[material];
    textures_.bind_colours(m.colour_map);
    textures_.bind_slopes(m.slope_map);
    glm::mat3 rows(0.0f);  // one per band
    for (std::size_t k = 0; k < 3 && first_band + k < scene.bands.size(); ++k) {
      const auto& w = scene.bands[first_band + k].facets->colour_weights[material];
      rows[glm::length_t(k)] = m.colour_map ? glm::vec3(w[0], w[1], w[2]) : glm::vec3(1, 0, 0);
    }
    gl_.UniformMatrix3fv(stage.weights, 1, GL_TRUE, &rows[0][0]);
  }

  /// Draws into `samples_`; false if the box is empty.
  bool draw_piece(const TileScene& scene, const Stage& stage, const TileMesh& mesh,
                  const TileBox& box, std::size_t first_band) {
    choose(mesh, box, scene.mesh->materials.size());
    if (indices_.empty()) return false;
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, std::ptrdiff_t(indices_.size() * 4), indices_.data(),
                   GL_STREAM_DRAW);
    const int width = box.columns * scene.oversampling, height = box.rows * scene.oversampling;
    gl_.Viewport(0, 0, width, height);
    const int columns = scene.camera.columns, rows = scene.camera.rows;
    gl_.Uniform4f(stage.piece, float(columns) / float(box.columns), float(rows) / float(box.rows),
                  float(columns - 2 * box.left - box.columns) / float(box.columns),
                  float(rows - 2 * box.top - box.rows) / float(box.rows));
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const Range& range : ranges_) {
      if (range.underlay) gl_.Enable(GL_POLYGON_OFFSET_FILL);
      if (!mesh.material.empty()) use_pictures(scene, stage, range.material, first_band);
      gl_.DrawElements(GL_TRIANGLES, int(range.count), GL_UNSIGNED_INT,
                       reinterpret_cast<const void*>(range.begin * 4));
      if (range.underlay) gl_.Disable(GL_POLYGON_OFFSET_FILL);
    }
    gl_.ReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, samples_.data());
    return true;
  }

  std::unique_ptr<GlContext> context_;
  Gl gl_;
  GlTextures textures_;
  Stage plain_, textured_;
  struct Range {
    std::size_t material, begin, count;  // first index and number of indices of a material
    bool underlay;
  };
  std::vector<Range> ranges_;
  std::vector<std::vector<std::uint32_t>> by_material_;
  std::vector<float> samples_;
  std::vector<std::uint32_t> indices_;
};

}  // namespace

std::unique_ptr<Renderer> make_gl_renderer() { return std::make_unique<GlRenderer>(); }

}  // namespace dmise
