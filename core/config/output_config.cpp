#include "core/config/output_config.h"

#include "core/config/yaml/bound_key.h"

namespace dmise {
namespace {

const Section& fits_section() {
  static const Section section{
      "fits",
      "How FITS files are written.",
      {required("compression", form::choice({"none", "rice"}),
                "`rice` compresses without loss, to about half the size.")}};
  return section;
}

const Section& radiance_section() {
  static const Section section{"radiance_exr",
                               "A map of radiance beside each frame.",
                               {required("bands", form::integer(1, 16),
                                         "Parts of the band, each a channel of its own. 1 writes "
                                         "the whole band alone.")}};
  return section;
}

}  // namespace

const Section& output_section() {
  static const Section section{
      "output",
      "Files of every frame.",
      {optional("fits", form::flag() | form::map(fits_section),
                "Whether each frame is written as FITS.", "on"),
       bound<&OutputConfig::saturation>(
           "saturation", form::flag(),
           "Writes flags of saturated pixels as a second image of the FITS file."),
       bound<&OutputConfig::png>("png", form::flag(),
                                 "Whether previews are written, plain and marked."),
       bound<&OutputConfig::truth>("truth", form::flag(),
                                   "Whether `truth.jsonl` says what was drawn into each frame."),
       bound<&OutputConfig::star_truth>(
           "star_truth", form::flag(),
           "Writes `frame-NNNNNN.stars.csv` with every star and planet that was drawn."),
       bound<&OutputConfig::preview_width_px>(
           "preview_width_px", form::integer(16, 32768),
           "Greatest width of a preview [px]. Wider frames are shrunk."),
       optional("radiance_exr", form::flag() | form::map(radiance_section),
                "Writes `frame-NNNNNN-radiance.exr`, the light at the aperture.", "off"),
       optional("planes", form::list(form::choice({"sources", "background", "noise"})),
                "Writes these expectations of each frame as `frame-NNNNNN-PLANE.fits`."),
       optional("positions", form::list(form::choice({"csv", "jsonl", "oem"})),
                "Writes positions of cameras, platforms, own objects, Sun and Moon at every tick "
                "in these formats."),
       optional("positions_frame", form::choice({"gcrs", "enu"}),
                "Axes of the tables of positions: GCRS, or east, north and up of the origin.",
                "gcrs")}};
  return section;
}

OutputConfig read_output(const YamlValue& value) {
  YamlMap map(value, output_section());
  OutputConfig output;
  if (const auto fits = map.find("fits")) {
    if (fits->is_map()) {
      YamlMap how(*fits, fits_section());
      output.fits_rice = how.require("compression").choice() == "rice";
      how.done();
    } else {
      output.fits = fits->flag();
    }
  }
  read_bound(map, output);
  if (output.saturation && !output.fits)
    map.require("saturation").fail("is stored in the FITS file: needs fits");
  if (const auto radiance = map.find("radiance_exr")) {
    if (radiance->is_map()) {
      YamlMap how(*radiance, radiance_section());
      output.radiance_bands = int(how.require("bands").integer());
      output.radiance_exr = true;
      how.done();
    } else {
      output.radiance_exr = radiance->flag();
    }
  }
  if (const auto planes = map.find("planes"))
    for (const auto& plane : planes->list()) {
      const auto flag =
          plane.chosen({&OutputConfig::sources, &OutputConfig::background, &OutputConfig::noise});
      output.*flag = true;
    }
  if (const auto positions = map.find("positions"))
    for (const auto& format : positions->list()) {
      const auto flag = format.chosen({&OutputConfig::positions_csv, &OutputConfig::positions_jsonl,
                                       &OutputConfig::positions_oem});
      output.*flag = true;
    }
  if (const auto frame = map.find("positions_frame")) {
    output.positions_enu = frame->choice() == "enu";
    output.positions_where = frame->place();
    if (!output.positions_csv && !output.positions_jsonl)
      frame->fail("is of positions: [csv] or [jsonl]");
  }
  map.done();
  return output;
}

}  // namespace dmise
