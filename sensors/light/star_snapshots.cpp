#include "sensors/light/star_snapshots.h"

#include "core/optics/projection.h"

namespace dmise {
namespace {

/// Snapshots are put on the plane together, as far as memory (6 MB) and single precision allow.
constexpr std::size_t max_points = 65536;
constexpr int max_snapshots = 64;

}  // namespace

std::vector<Deposited> draw_star_snapshots(const View& view, const StarColumns& columns,
                                           std::span<const StarTrail> stars,
                                           std::span<const double> signal_e, int count,
                                           const Spectra* spectra, OpticsStage& optics,
                                           const OcclusionMask& mask,
                                           ExpectedElectronImage& image) {
  const Optics& camera = view.sensor().camera.optics;
  std::vector<Deposited> result(stars.size());
  std::vector<Vec<Gcrs>> direction(stars.size());
  std::vector<std::uint32_t> catalogued;
  for (const StarTrail& star : stars)
    if (!star.astrometric) catalogued.push_back(star.place);
  std::vector<Vec<Gcrs>> of_catalogue(catalogued.size());
  std::vector<Arc> points, parts;
  std::vector<std::size_t> star_of;
  const auto put = [&] {
    const auto deposited = optics.add(points, image);
    for (std::size_t i = 0; i < points.size(); ++i)
      result[star_of[i]] = result[star_of[i]] + deposited[i];
    points.clear();
    star_of.clear();
  };
  for (int k = 0; k < count; ++k) {
    const SimTime t = view.times().at((k + 0.5) / count);
    const ApparentPlaces places = view.places(t);
    places.stars(columns, catalogued, of_catalogue);
    for (std::size_t i = 0, next = 0; i < stars.size(); ++i)
      direction[i] =
          stars[i].astrometric ? places.seen(*stars[i].astrometric) : of_catalogue[next++];
    const auto camera_from_gcrs = view.camera_from_gcrs(t);
    const Vec<Gcrs> up = view.up(t);
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const auto pixel = project(camera, camera_from_gcrs * direction[i]);
      if (!pixel) continue;
      const Arc point{*pixel, *pixel, *pixel, signal_e[i] / count * view.illumination(*pixel), 0.0};
      parts.assign(1, point);
      if (spectra) {
        const auto [blue, red] =
            spectra->ends(direction[i], Refraction::star, up, camera_from_gcrs, *pixel);
        parts.clear();
        spectra->add(point, {blue, blue, blue}, {red, red, red}, direction[i], stars[i].bv, parts);
      }
      for (const Arc& part : mask.past(parts)) {
        points.push_back(part);
        star_of.push_back(i);
      }
    }
    if (points.size() + stars.size() > max_points || (k + 1) % max_snapshots == 0) put();
  }
  put();
  return result;
}

}  // namespace dmise
