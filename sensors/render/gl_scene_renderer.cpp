#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "core/base/error.h"
#include "sensors/render/gl/gl.h"
#include "sensors/render/gl/gl_context.h"
#include "sensors/render/gl/gl_program.h"
#include "sensors/render/gl_renderer.h"
#include "sensors/render/scene_shaders.h"

namespace dmise {
namespace {

/// Cells of one piece per axis: 1 MB.
constexpr int piece_cells = 512;
/// A Gaussian at least this wide is integrated over a cell by quadrature.
constexpr double wide_sigma = 2.0;

struct PointInstance {
  glm::vec2 cell, phase;
  float light;
};

struct PatchInstance {
  glm::vec4 box, map;
  float coefficient[16];
};

/// A rectangle of cells, with exclusive ends.
struct Box {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// A program with one instance buffer.
struct Stage {
  unsigned program = 0, arrays = 0, buffer = 0;
  int piece = -1, spread = -1;
};

/// Assigns boxes to the pieces of a plane that they overlap, in order.
class Pieces {
 public:
  explicit Pieces(const ScenePlane& plane)
      : plane_(plane),
        across_((plane.columns + piece_cells - 1) / piece_cells),
        down_((plane.rows + piece_cells - 1) / piece_cells) {}

  int count() const { return across_ * down_; }
  Box box(int piece) const {
    const int left = piece % across_ * piece_cells, top = piece / across_ * piece_cells;
    return {left, top, std::min(left + piece_cells, plane_.columns),
            std::min(top + piece_cells, plane_.rows)};
  }

  /// `box_of(i)`: clipped to the plane, empty if outside.
  template <class BoxOf>
  void sort(std::size_t boxes, const BoxOf& box_of) {
    first_.assign(std::size_t(count()) + 1, 0);
    const auto visit = [&](const auto& use) {
      for (std::size_t i = 0; i < boxes; ++i) {
        const Box b = box_of(i);
        if (b.left >= b.right || b.top >= b.bottom) continue;
        for (int y = b.top / piece_cells; y <= (b.bottom - 1) / piece_cells; ++y)
          for (int x = b.left / piece_cells; x <= (b.right - 1) / piece_cells; ++x)
            use(std::size_t(y * across_ + x), std::uint32_t(i));
      }
    };
    visit([&](std::size_t piece, std::uint32_t) { ++first_[piece + 1]; });
    for (std::size_t p = 1; p < first_.size(); ++p) first_[p] += first_[p - 1];
    order_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    visit([&](std::size_t piece, std::uint32_t i) { order_[next[piece]++] = i; });
  }
  std::span<const std::uint32_t> in(int piece) const {
    const std::size_t from = first_[std::size_t(piece)], to = first_[std::size_t(piece) + 1];
    return std::span(order_).subspan(from, to - from);
  }

 private:
  ScenePlane plane_;
  int across_, down_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> order_;
};

class GlSceneRenderer final : public SceneRenderer {
 public:
  GlSceneRenderer() : context_(open_gl()), gl_(load_gl(*context_)) {
    make_target();
    points_ = make_stage(point_vertex_shader, point_fragment_shader, sizeof(PointInstance),
                         {{2, 0}, {2, 8}, {1, 16}});
    patches_ = make_stage(patch_vertex_shader, patch_fragment_shader, sizeof(PatchInstance),
                          {{4, 0}, {4, 16}, {4, 32}, {4, 48}, {4, 64}, {4, 80}});
    cells_.resize(std::size_t(piece_cells) * piece_cells);
  }

  std::string description() const override { return description_of(gl_, *context_); }

  void add_points(std::span<const ScenePoint> points, double sigma,
                  const ScenePlane& plane) override {
    if (!(sigma >= 0.02 && sigma <= 500.0)) throw Error("scene: sigma must be in 0.02..500 cells");
    check(plane);
    const int reach = int(std::ceil(5 * sigma + 0.5));
    const auto box_of = [&](std::size_t i) {
      const auto side = [&](double at, int cells) {
        const double cell = std::clamp(std::floor(at), -1e6, 1e6);
        return std::pair(std::max(0, int(cell) + 1 - reach),
                         std::min(cells, int(cell) + 1 + reach));
      };
      const auto [left, right] = side(points[i].x, plane.columns);
      const auto [top, bottom] = side(points[i].y, plane.rows);
      return Box{left, top, right, bottom};
    };
    begin(points_);
    gl_.Enable(GL_BLEND);
    gl_.Uniform4f(points_.spread, float(1 / sigma), float(std::sqrt(0.5) / sigma),
                  float(std::sqrt(0.5 / M_PI) / sigma), sigma >= wide_sigma ? 1.0f : 0.0f);
    pieces_of(plane, points.size(), box_of, [&](const Box& piece, auto numbers) {
      std::vector<PointInstance>& instances = point_instances_;
      instances.clear();
      for (const std::uint32_t i : numbers) {
        const ScenePoint& p = points[i];
        const double x = std::floor(p.x), y = std::floor(p.y);
        instances.push_back({{float(x - piece.left), float(y - piece.top)},
                             {float(p.x - x), float(p.y - y)},
                             float(p.light)});
      }
      gl_.Uniform4f(points_.piece, 2.0f / float(piece.right - piece.left),
                    2.0f / float(piece.bottom - piece.top), float(reach), 0.0f);
      draw(instances.data(), instances.size(), sizeof(PointInstance));
    });
    gl_.Disable(GL_BLEND);
  }

  void add_patches(std::span<const SkyPatch> patches, const ScenePlane& plane) override {
    check(plane);
    const auto box_of = [&](std::size_t i) {
      const SkyPatch& p = patches[i];
      return Box{std::max(0, p.x0), std::max(0, p.y0), std::min(plane.columns, p.x1 + 1),
                 std::min(plane.rows, p.y1 + 1)};
    };
    begin(patches_);
    pieces_of(plane, patches.size(), box_of, [&](const Box& piece, auto numbers) {
      std::vector<PatchInstance>& instances = patch_instances_;
      instances.clear();
      for (const std::uint32_t i : numbers) {
        const SkyPatch& p = patches[i];
        PatchInstance& to = instances.emplace_back(
            PatchInstance{{float(p.x0 - piece.left), float(p.y0 - piece.top),
                           float(p.x1 + 1 - piece.left), float(p.y1 + 1 - piece.top)},
                          {p.u0, p.du, p.v0, p.dv},
                          {}});
        std::copy(p.coefficient.begin(), p.coefficient.end(), to.coefficient);
      }
      gl_.Uniform4f(patches_.piece, 2.0f / float(piece.right - piece.left),
                    2.0f / float(piece.bottom - piece.top), 0.0f, 0.0f);
      draw(instances.data(), instances.size(), sizeof(PatchInstance));
    });
  }

 private:
  struct Attribute {
    int floats;
    std::size_t offset;
  };

  static void check(const ScenePlane& plane) {
    if (!plane.cells || plane.columns < 1 || plane.rows < 1 || plane.stride < plane.columns)
      throw Error("scene: no cells to draw on");
  }

  void make_target() {
    unsigned frame = 0, buffer = 0;
    gl_.GenFramebuffers(1, &frame);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl_.GenRenderbuffers(1, &buffer);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl_.RenderbufferStorage(GL_RENDERBUFFER, GL_R32F, piece_cells, piece_cells);
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error("OpenGL cannot draw into 32-bit floats");
    gl_.ClearColor(0, 0, 0, 0);
    gl_.BlendFunc(GL_ONE, GL_ONE);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.PixelStorei(GL_PACK_ALIGNMENT, 1);
  }

  Stage make_stage(const char* vertex_shader, const char* fragment_shader, int stride,
                   std::initializer_list<Attribute> attributes) {
    Stage stage;
    stage.program = link_program(gl_, vertex_shader, fragment_shader);
    stage.piece = gl_.GetUniformLocation(stage.program, "piece");
    stage.spread = gl_.GetUniformLocation(stage.program, "spread");
    gl_.CreateVertexArrays(1, &stage.arrays);
    gl_.BindVertexArray(stage.arrays);
    gl_.GenBuffers(1, &stage.buffer);
    gl_.BindBuffer(GL_ARRAY_BUFFER, stage.buffer);
    unsigned location = 0;
    for (const auto& [floats, offset] : attributes) {
      gl_.VertexAttribPointer(location, floats, GL_FLOAT, GL_FALSE, stride,
                              reinterpret_cast<const void*>(offset));
      gl_.EnableVertexAttribArray(location);
      gl_.VertexAttribDivisor(location++, 1);
    }
    return stage;
  }

  void begin(const Stage& stage) {
    context_->make_current();
    gl_.UseProgram(stage.program);
    gl_.BindVertexArray(stage.arrays);
    gl_.BindBuffer(GL_ARRAY_BUFFER, stage.buffer);
  }

  void draw(const void* instances, std::size_t count, std::size_t size) {
    gl_.BufferData(GL_ARRAY_BUFFER, std::ptrdiff_t(count * size), instances, GL_STREAM_DRAW);
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, int(count));
  }

  /// Draws piece by piece, clears and reads the covered area, and adds it to the plane.
  template <class BoxOf, class Draw>
  void pieces_of(const ScenePlane& plane, std::size_t boxes, const BoxOf& box_of,
                 const Draw& draw_piece) {
    Pieces pieces(plane);
    pieces.sort(boxes, box_of);
    for (int p = 0; p < pieces.count(); ++p) {
      const auto numbers = pieces.in(p);
      if (numbers.empty()) continue;
      const Box piece = pieces.box(p);
      Box used{piece.right, piece.bottom, piece.left, piece.top};
      for (const std::uint32_t i : numbers) {
        const Box b = box_of(i);
        used = {std::min(used.left, b.left), std::min(used.top, b.top),
                std::max(used.right, b.right), std::max(used.bottom, b.bottom)};
      }
      used = {std::max(used.left, piece.left), std::max(used.top, piece.top),
              std::min(used.right, piece.right), std::min(used.bottom, piece.bottom)};
      const int x = used.left - piece.left, y = used.top - piece.top;
      const int width = used.right - used.left, height = used.bottom - used.top;
      gl_.Viewport(0, 0, piece.right - piece.left, piece.bottom - piece.top);
      gl_.Scissor(x, y, width, height);
      gl_.Clear(GL_COLOR_BUFFER_BIT);
      draw_piece(piece, numbers);
      gl_.ReadPixels(x, y, width, height, GL_RED, GL_FLOAT, cells_.data());
      for (int row = 0; row < height; ++row) {
        const float* from = cells_.data() + std::size_t(row) * std::size_t(width);
        float* to = plane.cells + (used.top + row) * plane.stride + used.left;
        for (int column = 0; column < width; ++column) to[column] += from[column];
      }
    }
    if (const unsigned error = gl_.GetError(); error != GL_NO_ERROR)
      throw Error("OpenGL error " + std::to_string(error));
  }

  std::unique_ptr<GlContext> context_;
  Gl gl_;
  Stage points_, patches_;
  std::vector<PointInstance> point_instances_;
  std::vector<PatchInstance> patch_instances_;
  std::vector<float> cells_;
};

}  // namespace

std::unique_ptr<SceneRenderer> make_gl_scene_renderer() {
  return std::make_unique<GlSceneRenderer>();
}

}  // namespace dmise
