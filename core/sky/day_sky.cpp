#include "core/sky/day_sky.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/table_place.h"
#include "core/base/units.h"
#include "core/photometry/spectrum.h"
#include "core/sky/air/standard_air.h"
#include "core/sky/air_shells.h"
#include "core/sky/diffuse_light.h"
#include "core/sky/limb_air.h"

namespace dmise {
namespace {

// Nodes of the tables: altitudes by their square root, azimuths evenly.
constexpr std::size_t altitude_nodes = 49, azimuth_nodes = 25;

double altitude_of_node(std::size_t i) {
  const double t = double(i) / (altitude_nodes - 1);
  return 0.5 * pi * t * t;
}
double azimuth_of_node(std::size_t i) { return pi * double(i) / (azimuth_nodes - 1); }

/// Share of a piece of the band that gases leave, by their amounts on the way: water [mm], and
/// mixed gases in vertical columns from the sea.
class PieceGases {
 public:
  static constexpr std::size_t water_nodes = 24, mixed_nodes = 12;
  static constexpr double max_water_mm = 4000.0, max_mixed = 80.0;

  explicit PieceGases(std::vector<double> depths) : depths_(std::move(depths)) {}

  /// Amounts at nodes, which are denser towards none.
  static double water_of_node(std::size_t i) {
    return max_water_mm * std::pow(double(i) / (water_nodes - 1), 4);
  }
  static double mixed_of_node(std::size_t i) {
    return max_mixed * std::pow(double(i) / (mixed_nodes - 1), 4);
  }
  double transmission(double water_mm, double mixed) const {
    const TablePlace w = place(water_mm / max_water_mm, water_nodes),
                     u = place(mixed / max_mixed, mixed_nodes);
    const auto along = [&](std::size_t row) {
      const double* d = depths_.data() + row * mixed_nodes + u.node;
      return d[0] + u.part * (d[1] - d[0]);
    };
    const double low = along(w.node);
    return std::exp(-(low + w.part * (along(w.node + 1) - low)));
  }

 private:
  static TablePlace place(double share, std::size_t nodes) {
    return table_place(std::sqrt(std::sqrt(share)) * double(nodes - 1), nodes);
  }
  std::vector<double> depths_;  // water x mixed
};

/// A piece of the band: sunlight at 1 au, and the wavelength at which it is scattered.
struct BandPiece {
  double wavelength_m = 0.0, photons_per_s_m2 = 0.0;
  std::optional<PieceGases> gases;
};

/// Photons of a piece by wavelength.
struct PhotonSample {
  double wavelength_m, photons_per_s_m2;
};

std::vector<std::vector<PhotonSample>> photons_of_pieces(const Band& band) {
  constexpr double relative_width = 0.06;
  constexpr int samples = 24;
  const double ratio = std::log(band.high_m() / band.low_m());
  const int count = std::max(1, int(std::ceil(ratio / relative_width)));
  std::vector<std::vector<PhotonSample>> pieces;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const double low_m = band.low_m() * std::exp(ratio * k / count),
                 step_m = (band.low_m() * std::exp(ratio * (k + 1) / count) - low_m) / samples;
    std::vector<PhotonSample> piece;
    for (int i = 0; i < samples; ++i) {
      const double x_m = low_m + (i + 0.5) * step_m;
      const double photons = sunlight_spectrum().irradiance.at_or_zero(x_m) *
                             band.response.at_or_zero(x_m) * x_m * step_m;
      sum += photons;
      piece.push_back({x_m, photons});
    }
    pieces.push_back(std::move(piece));
  }
  const double scale = photon_rate_per_m2(sunlight_spectrum(), band) / std::max(sum, 1e-300);
  for (auto& piece : pieces)
    for (PhotonSample& sample : piece) sample.photons_per_s_m2 *= scale;
  return pieces;
}

/// Transmissions of gases at all wavelengths, at the nodes of `PieceGases`.
std::vector<Curve> gas_curves() {
  constexpr double airmass = 100.0;  // so that amounts are within the limits of `AirGases`
  std::vector<Curve> curves;
  for (std::size_t w = 0; w < PieceGases::water_nodes; ++w)
    for (std::size_t u = 0; u < PieceGases::mixed_nodes; ++u)
      curves.push_back(
          gas_transmission({.pwv_mm = PieceGases::water_of_node(w) / airmass,
                            .pressure_hpa = PieceGases::mixed_of_node(u) / airmass * sea_level_hpa},
                           airmass));
  return curves;
}

std::vector<BandPiece> pieces_of(const Band& band, bool absorbed) {
  constexpr double first_gas_m = 570 * nm;
  std::vector<BandPiece> pieces;
  for (const auto& samples : photons_of_pieces(band)) {
    BandPiece piece;
    for (const PhotonSample& s : samples) {
      piece.photons_per_s_m2 += s.photons_per_s_m2;
      piece.wavelength_m += s.photons_per_s_m2 * s.wavelength_m;
    }
    if (!(piece.photons_per_s_m2 > 0.0)) continue;
    piece.wavelength_m /= piece.photons_per_s_m2;
    if (absorbed && samples.back().wavelength_m > first_gas_m) {
      static const std::vector<Curve> curves = gas_curves();
      std::vector<double> depths;
      for (const Curve& curve : curves) {
        double left = 0.0;
        for (const PhotonSample& s : samples)
          left += s.photons_per_s_m2 * curve.at_or_end(s.wavelength_m);
        depths.push_back(-std::log(std::max(left / piece.photons_per_s_m2, 1e-30)));
      }
      piece.gases.emplace(std::move(depths));
    }
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

/// Depths of vertical columns at one wavelength. Light in haze's forward peak counts as not
/// scattered, but where it is scattered once.
struct ColumnDepths {
  double molecules, haze_once, haze_again, haze, ozone;  // scattering, then extinction

  ColumnDepths(const DayAir& air, double wavelength_m)
      : molecules(rayleigh_depth(wavelength_m) * air.pressure_hpa / sea_level_hpa),
        haze_once(haze_scattering_albedo * air.haze.depth_at(wavelength_m)),
        haze_again(haze_once * (1.0 - haze_forward_share)),
        haze(air.haze.depth_at(wavelength_m) - haze_once * haze_forward_share),
        ozone(ozone_absorption(wavelength_m)) {}

  double of(const AirAmounts& amounts) const {
    return molecules * amounts.molecules + haze * amounts.haze + ozone * amounts.ozone;
  }
};

/// Light that falls on a piece of a line of sight.
struct SunOnPiece {
  AirAmounts before;
  double share;
};

LayeredAir layered(const AirShells& shells, const ColumnDepths& depths, const DayAir& air,
                   const std::vector<SunOnPiece>& sun_at_levels, double sin_sun_altitude) {
  LayeredAir layers{.sun_cosine = sin_sun_altitude, .ground_albedo = air.ground_albedo};
  for (std::size_t i = 0; i < shells.levels(); ++i) {
    const AirAmounts& here = shells.at_level(i);
    const double extinction = std::max(depths.of(here), 1e-300);
    layers.molecules.push_back(depths.molecules * here.molecules / extinction);
    layers.haze.push_back(depths.haze_again * here.haze / extinction);
    layers.sunlight.push_back(sun_at_levels[i].share *
                              std::exp(-depths.of(sun_at_levels[i].before)));
    if (i + 1 < shells.levels())
      layers.layer_depth.push_back((shells.radius_m(i + 1) - shells.radius_m(i)) *
                                   depths.of(shells.in_shell(i)));
  }
  return layers;
}

/// Weights of Catmull & Rom 1974 of four nodes, between the middle ones.
std::array<double, 4> cubic_weights(double t) {
  return {0.5 * t * (t * (2.0 - t) - 1.0), 0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
          0.5 * t * (t * (4.0 - 3.0 * t) + 1.0), 0.5 * t * t * (t - 1.0)};
}

}  // namespace

/// Sums along all lines of the table.
struct DaySky::Sums {
  const DayAir& air;
  double sin_sun_altitude;
  AirShells shells{air.height_m};
  std::vector<LineThroughShells> lines;  // by altitude
  std::vector<SunOnPiece> sun;           // altitudes x azimuths x pieces
  std::vector<SunOnPiece> sun_at_levels;

  Sums(const DayAir& of, double sine) : air(of), sin_sun_altitude(sine) {
    const double cos_sun_altitude = std::sqrt(std::max(0.0, 1.0 - sine * sine));
    const double ground_m = shells.radius_m(0);
    for (std::size_t a = 0; a < altitude_nodes; ++a) {
      const double altitude_rad = altitude_of_node(a);
      lines.emplace_back(shells, std::sin(altitude_rad));
      for (std::size_t z = 0; z < azimuth_nodes; ++z) {
        const double towards_sun =
            std::cos(altitude_rad) * std::cos(azimuth_of_node(z)) * cos_sun_altitude +
            std::sin(altitude_rad) * sine;
        for (const auto& piece : lines.back().pieces)
          sun.push_back(sun_at(piece.radius_m,
                               (ground_m * sine + piece.middle_m * towards_sun) / piece.radius_m));
      }
    }
    for (std::size_t i = 0; i < shells.levels(); ++i)
      sun_at_levels.push_back(sun_at(shells.radius_m(i), sine));
  }

  SunOnPiece sun_at(double radius_m, double sine) const {
    const double share = shells.sunlit_share(radius_m, sine);
    return {share > 0.0 ? shells.towards(radius_m, sine) : AirAmounts{}, share};
  }

  /// Share of light that gases leave on both ways.
  double through_gases(const BandPiece& piece, const AirAmounts& in, const AirAmounts& out) const {
    return piece.gases->transmission(
        air.gases->pwv_mm * (in.haze + out.haze),
        air.gases->pressure_hpa / sea_level_hpa * (in.molecules + out.molecules));
  }

  void add(const BandPiece& piece, std::vector<Parts>& parts) const {
    const ColumnDepths depths(air, piece.wavelength_m);
    const DiffuseLight diffuse(layered(shells, depths, air, sun_at_levels, sin_sun_altitude));
    for (std::size_t a = 0; a < altitude_nodes; ++a) {
      std::vector<double> reaches, depth;  // light of each piece that arrives; its depth
      for (std::size_t i = 0; i < lines[a].pieces.size(); ++i) {
        const auto& p = lines[a].pieces[i];
        depth.push_back(p.length_m * depths.of(shells.in_shell(i)));
        const double start = depths.of(p.before) - 0.5 * depth.back();
        reaches.push_back(std::exp(-start) *
                          (depth.back() > 1e-9 ? -std::expm1(-depth.back()) : depth.back()));
      }
      const std::vector<double> modes = diffuse_modes(diffuse, lines[a], reaches);
      for (std::size_t z = 0; z < azimuth_nodes; ++z) {
        const SunOnPiece* s = sun.data() + (a * azimuth_nodes + z) * depth.size();
        Parts once;
        double without_gases = 0.0, with_gases = 0.0;
        for (std::size_t i = 0; i < depth.size(); ++i) {
          if (!(s[i].share > 0.0) || !(depth[i] > 0.0)) continue;
          const auto& p = lines[a].pieces[i];
          const AirAmounts& there = shells.in_shell(i);
          double light =
              s[i].share * std::exp(-depths.of(s[i].before)) * reaches[i] / depth[i] * p.length_m;
          const double scattered =
              depths.molecules * there.molecules + depths.haze_once * there.haze;
          without_gases += light * scattered;
          if (piece.gases) light *= through_gases(piece, s[i].before, p.before);
          with_gases += light * scattered;
          once.molecules += light * depths.molecules * there.molecules;
          once.haze += light * depths.haze_once * there.haze;
        }
        double again = 0.0;
        for (std::size_t m = 0; m < modes.size(); ++m)
          again += modes[m] * std::cos(double(m) * azimuth_of_node(z));
        if (without_gases > 0.0) again *= with_gases / without_gases;
        Parts& sum = parts[a * azimuth_nodes + z];
        const double of_sphere = piece.photons_per_s_m2 / (4.0 * pi);
        sum.molecules += of_sphere * once.molecules;
        sum.haze += of_sphere * once.haze;
        sum.diffuse += piece.photons_per_s_m2 * again;
      }
    }
  }

  /// Diffuse light along a line, by modes.
  std::vector<double> diffuse_modes(const DiffuseLight& diffuse, const LineThroughShells& line,
                                    const std::vector<double>& reaches) const {
    // Lines rise over the curved ground: their altitude is that over where most air is.
    constexpr double max_air_m = 3e3;
    const double ground_m = shells.radius_m(0), r = ground_m + max_air_m;
    const double sine = std::sqrt(1.0 - ground_m * ground_m / (r * r) *
                                            (1.0 - line.sin_altitude * line.sin_altitude));
    std::vector<double> modes;
    for (int m = 0; m < diffuse.modes_used(); ++m) {
      std::array<double, DiffuseLight::modes> functions;
      const std::span used(functions.data(), std::size_t(DiffuseLight::modes - m));
      legendre_functions(m, -sine, used);
      double sum = 0.0, low = diffuse.source(m, 0, used);
      for (std::size_t i = 0; i < reaches.size(); ++i) {
        const double high = diffuse.source(m, i + 1, used);
        sum += 0.5 * (low + high) * reaches[i];
        low = high;
      }
      modes.push_back(sum);
    }
    return modes;
  }
};

DaySky::DaySky(const Band& band, const DayAir& air, double sin_sun_altitude)
    : parts_(altitude_nodes * azimuth_nodes) {
  const Sums sums(air, sin_sun_altitude);
  for (const BandPiece& piece : pieces_of(band, air.gases.has_value())) sums.add(piece, parts_);
}

double DaySky::photons_per_s_m2_sr(const DayDirection& d) const {
  const double altitude_rad = std::asin(std::clamp(d.sin_altitude, 0.0, 1.0));
  const TablePlace a =
      table_place(std::sqrt(altitude_rad / (0.5 * pi)) * (altitude_nodes - 1), altitude_nodes);
  const TablePlace z =
      table_place(std::abs(d.azimuth_from_sun_rad) / pi * (azimuth_nodes - 1), azimuth_nodes);
  const auto along = cubic_weights(a.part), across = cubic_weights(z.part);
  Parts sum;
  for (std::size_t i = 0; i < 4; ++i) {
    // Beyond the zenith the line through its node, below the horizon the horizon.
    const std::size_t row = std::clamp<std::size_t>(a.node + i, 1, altitude_nodes) - 1;
    for (std::size_t j = 0; j < 4; ++j) {
      // Mirrored in the Sun's vertical.
      const std::size_t at = z.node + j;
      const std::size_t column = at == 0 ? 1 : at > azimuth_nodes ? azimuth_nodes - 2 : at - 1;
      const Parts& node = parts_[row * azimuth_nodes + column];
      const double weight = along[i] * across[j];
      sum.molecules += weight * node.molecules;
      sum.haze += weight * node.haze;
      sum.diffuse += weight * node.diffuse;
    }
  }
  const double cosine = std::clamp(d.cos_angle_from_sun, -1.0, 1.0);
  return std::max(
      0.0, sum.molecules * rayleigh_phase(cosine) + sum.haze * haze_phase(cosine) + sum.diffuse);
}

}  // namespace dmise
