#include "sensors/sky/star_path_grid.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/simd_level.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr double widest_margin_px = 512.0;  // paths that are longer take no grid
constexpr double coarsest_px = 64.0, finest_px = 16.0;
constexpr double max_bad = 0.05;  // share of patches, before the grid is made finer
constexpr double direction_tolerance = 1e-7, relative_tolerance = 1e-4;

}  // namespace

StarPathGrid::StarPathGrid(const View& view, const Exact& exact)
    : optics_(&view.sensor().camera.optics), camera_(view.camera_from_gcrs(view.times().middle)) {
  // How far stars are from their astrometric places, along the rim and across.
  constexpr int looks = 8;
  double farthest_px = 0.0;
  for (int i = 0; i <= looks; ++i)
    for (int j = 0; j <= looks; ++j) {
      const auto node = look(
          {-0.5 + double(i) / looks * optics_->columns, -0.5 + double(j) / looks * optics_->rows},
          exact);
      if (!node) continue;
      for (std::size_t k = 0; k < 6; ++k) farthest_px = std::max(farthest_px, std::abs((*node)[k]));
    }
  const double margin_px = 1.5 * farthest_px + 8.0;
  if (margin_px > widest_margin_px) return;
  for (double spacing_px = coarsest_px; spacing_px >= finest_px; spacing_px *= 0.5) {
    make(spacing_px, margin_px, exact);
    if (bad_share() <= max_bad) return;
  }
}

double StarPathGrid::bad_share() const {
  return double(std::ranges::count(good_, 0)) / double(std::max<std::size_t>(1, good_.size()));
}

PixelPosition StarPathGrid::node_at(double column, double row) const {
  return {left_ + spacing_px_ * column, top_ + spacing_px_ * row};
}

std::optional<StarPathGrid::Node> StarPathGrid::look(PixelPosition at, const Exact& exact) const {
  const auto direction = unproject(*optics_, at);
  if (!direction) return std::nullopt;
  const Vec<Gcrs> astrometric = unit(camera_.inverse() * *direction);
  // Beyond a fold of the projection a pixel's direction has another pixel.
  const auto back = project(*optics_, camera_ * astrometric);
  if (!back || std::hypot(back->x_px - at.x_px, back->y_px - at.y_px) > 1e-6) return std::nullopt;
  const auto path = exact(astrometric);
  if (!path) return std::nullopt;
  Node node{};
  for (std::size_t k = 0; k < 3; ++k) {
    node[2 * k] = path->pixel[k].x_px - at.x_px;
    node[2 * k + 1] = path->pixel[k].y_px - at.y_px;
  }
  const Vec<Gcrs> turned = path->middle - astrometric;
  node[6] = turned.x, node[7] = turned.y, node[8] = turned.z;
  node[9] = path->airmass, node[10] = path->illumination;
  for (const double value : node)
    if (!std::isfinite(value)) return std::nullopt;
  return node;
}

void StarPathGrid::make(double spacing_px, double margin_px, const Exact& exact) {
  spacing_px_ = spacing_px;
  const auto patches = [&](int pixels) {
    return std::size_t(std::ceil((pixels + 2.0 * margin_px) / (2.0 * spacing_px)));
  };
  columns_ = patches(optics_->columns), rows_ = patches(optics_->rows);
  const std::size_t across = 2 * columns_ + 1, down = 2 * rows_ + 1;
  left_ = 0.5 * (optics_->columns - 1) - spacing_px * double(columns_);
  top_ = 0.5 * (optics_->rows - 1) - spacing_px * double(rows_);
  nodes_.assign(across * down, Node{});
  has_node_.assign(across * down, 0);
  good_.assign(columns_ * rows_, 0);
  for (std::size_t j = 0; j < down; ++j)
    for (std::size_t i = 0; i < across; ++i)
      if (const auto node = look(node_at(double(i), double(j)), exact)) {
        nodes_[j * across + i] = *node;
        has_node_[j * across + i] = 1;
      }
  for (std::size_t j = 0; j < rows_; ++j)
    for (std::size_t i = 0; i < columns_; ++i) good_[j * columns_ + i] = holds(i, j, exact);
}

PatchPlace StarPathGrid::place_in(std::size_t i, std::size_t j, double u, double v) const {
  return {2 * j * (2 * columns_ + 1) + 2 * i, u, v};
}

void StarPathGrid::interpolate(std::span<const PatchPlace> places, std::span<Node> out) const {
  static const auto kernel = kernel_of(best_simd_level(), sse2::interpolate_paths,
                                       avx2::interpolate_paths, avx512::interpolate_paths);
  kernel(nodes_.data()->data(), 2 * columns_ + 1, places.data(), places.size(), out.data()->data());
}

bool StarPathGrid::holds(std::size_t i, std::size_t j, const Exact& exact) const {
  const std::size_t across = 2 * columns_ + 1;
  for (std::size_t b = 0; b < 3; ++b)
    for (std::size_t a = 0; a < 3; ++a)
      if (!has_node_[(2 * j + b) * across + 2 * i + a]) return false;
  // Where a polynomial of third degree is missed most: 1 / sqrt(3) from the middle.
  constexpr double low = 1.0 - 0.57735, high = 1.0 + 0.57735;
  for (const auto& [u, v] : {std::array{low, high}, std::array{high, high}}) {
    const auto truly = look(node_at(2.0 * double(i) + u, 2.0 * double(j) + v), exact);
    if (!truly) return false;
    const PatchPlace place = place_in(i, j, u, v);
    Node node;
    interpolate({&place, 1}, {&node, 1});
    for (std::size_t k = 0; k < values; ++k) {
      const double tolerance = k < 6   ? 0.5 * tolerance_px
                               : k < 9 ? direction_tolerance
                                       : relative_tolerance * std::max(1e-3, std::abs((*truly)[k]));
      if (!(std::abs(node[k] - (*truly)[k]) <= tolerance)) return false;
    }
  }
  return true;
}

void StarPathGrid::find(std::span<const Vec<Gcrs>> astrometric, std::span<StarPath> paths,
                        std::span<Found> found) const {
  std::vector<PatchPlace> places;
  std::vector<PixelPosition> pixels;
  places.reserve(found.size()), pixels.reserve(found.size());
  const PixelPosition centre = principal_point(*optics_);
  const double focal_length_px = optics_->focal_length_px(), per_spacing = 1.0 / spacing_px_;
  for (std::size_t n = 0; n < found.size(); ++n) {
    found[n] = Found::none;
    if (good_.empty()) continue;
    const Vec<CameraFrame> direction = camera_ * astrometric[n];
    const auto image = optics_->projection.image_of(direction.x, direction.y, direction.z);
    if (!image) continue;
    const PixelPosition at{centre.x_px + focal_length_px * (*image)[0],
                           centre.y_px + focal_length_px * (*image)[1]};
    const double u = (at.x_px - left_) * per_spacing, v = (at.y_px - top_) * per_spacing;
    if (!(u >= 0.0 && v >= 0.0 && u < 2.0 * double(columns_) && v < 2.0 * double(rows_))) {
      found[n] = Found::beside;
      continue;
    }
    const auto i = std::size_t(0.5 * u), j = std::size_t(0.5 * v);
    if (!good_[j * columns_ + i]) continue;
    found[n] = Found::path;
    places.push_back(place_in(i, j, u - 2.0 * double(i), v - 2.0 * double(j)));
    pixels.push_back(at);
  }
  std::vector<Node> nodes(places.size());
  if (!nodes.empty()) interpolate(places, nodes);
  std::size_t next = 0;
  for (std::size_t n = 0; n < found.size(); ++n) {
    if (found[n] != Found::path) continue;
    const Node& node = nodes[next];
    const PixelPosition at = pixels[next++];
    StarPath& path = paths[n];
    for (std::size_t k = 0; k < 3; ++k)
      path.pixel[k] = {at.x_px + node[2 * k], at.y_px + node[2 * k + 1]};
    path.middle = astrometric[n] + Vec<Gcrs>{node[6], node[7], node[8]};
    path.airmass = node[9];
    path.illumination = node[10];
  }
}

}  // namespace dmise
