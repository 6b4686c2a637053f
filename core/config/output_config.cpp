#include "core/config/output_config.h"

namespace dmise {

OutputConfig read_output(const YamlValue& value) {
  YamlMap map(value);
  OutputConfig output;
  if (const auto fits = map.find("fits")) {
    if (fits->is_map()) {
      YamlMap how(*fits);
      output.fits_rice = how.require("compression").choice({"none", "rice"}) == "rice";
      how.done();
    } else {
      output.fits = fits->flag();
    }
  }
  const auto saturation = map.find("saturation");
  if (saturation) output.saturation = saturation->flag();
  if (output.saturation && !output.fits) saturation->fail("is stored in the FITS file: needs fits");
  output.png = map.flag_or("png", true);
  output.truth = map.flag_or("truth", true);
  output.star_truth = map.flag_or("star_truth", false);
  output.preview_width_px = static_cast<int>(map.integer_or("preview_width_px", 1663, 16, 32768));
  if (const auto radiance = map.find("radiance_exr")) {
    if (radiance->is_map()) {
      YamlMap how(*radiance);
      output.radiance_bands = int(how.require("bands").integer(1, 16));
      output.radiance_exr = true;
      how.done();
    } else {
      output.radiance_exr = radiance->flag();
    }
  }
  if (const auto planes = map.find("planes"))
    for (const auto& plane : planes->list()) {
      const std::string name = plane.choice({"sources", "background", "noise"});
      (name == "sources"      ? output.sources
       : name == "background" ? output.background
                              : output.noise) = true;
    }
  if (const auto positions = map.find("positions"))
    for (const auto& format : positions->list()) {
      const std::string name = format.choice({"csv", "jsonl", "oem"});
      (name == "csv"     ? output.positions_csv
       : name == "jsonl" ? output.positions_jsonl
                         : output.positions_oem) = true;
    }
  if (const auto frame = map.find("positions_frame")) {
    output.positions_enu = frame->choice({"gcrs", "enu"}) == "enu";
    output.positions_where = frame->place();
    if (!output.positions_csv && !output.positions_jsonl)
      frame->fail("is of positions: [csv] or [jsonl]");
  }
  map.done();
  return output;
}

}  // namespace dmise
