#include "core/detection/measured_source.h"

#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/formatted.h"

namespace dmise {
namespace {

void require(bool holds, const std::string& key, const std::string& rule, double got) {
  if (!holds) throw Error(key + ": must be " + rule + formatted(", got %.9g", got));
}

void check_number(const std::string& key, double value, double least, double most) {
  require(std::isfinite(value), key, "finite", value);
  require(value >= least && value <= most, key, formatted("from %.9g to %.9g", least, most), value);
}

void check_positive(const std::string& key, double value) {
  require(std::isfinite(value), key, "finite", value);
  require(value > 0, key, "> 0", value);
}

void check_place(const std::string& key, const MeasuredPlace& measured, int columns, int rows) {
  check_number(key + "x_px", measured.place.x_px, -max_outside_px, columns - 1 + max_outside_px);
  check_number(key + "y_px", measured.place.y_px, -max_outside_px, rows - 1 + max_outside_px);
  const auto& [xx, xy, yy] = measured.covariance_px2;
  constexpr double max_variance_px2 = max_sigma_px * max_sigma_px;
  check_positive(key + "var_x_px2", xx);
  check_positive(key + "var_y_px2", yy);
  check_number(key + "var_x_px2", xx, 0.0, max_variance_px2);
  check_number(key + "var_y_px2", yy, 0.0, max_variance_px2);
  require(std::isfinite(xy), key + "cov_xy_px2", "finite", xy);
  require(xy * xy < xx * yy, key + "cov_xy_px2",
          "that of a covariance, smaller than the geometric mean of both variances", xy);
}

}  // namespace

void check_sources(const std::vector<MeasuredSource>& sources, int columns, int rows) {
  if (sources.size() > max_measured_sources)
    throw Error("found: must be at most " + std::to_string(max_measured_sources) +
                " sources, got " + std::to_string(sources.size()));
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const MeasuredSource& source = sources[i];
    const std::string key = "found[" + std::to_string(i) + "].";
    check_place(key, source.centroid, columns, rows);
    check_positive(key + "flux_e", source.light_e);
    check_positive(key + "snr", source.snr);
    if (!source.ends) continue;
    const auto& [first, last] = *source.ends;
    check_place(key + "end1.", first, columns, rows);
    check_place(key + "end2.", last, columns, rows);
    const PixelPosition way = last.place - first.place;
    require(std::hypot(way.x_px, way.y_px) > 0, key + "end2", "another place than end1",
            last.place.x_px);
  }
}

}  // namespace dmise
