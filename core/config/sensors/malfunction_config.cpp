#include "core/config/sensors/malfunction_config.h"

#include <iterator>

namespace dmise {

const Section& malfunction_section() {
  static const Section section{
      "malfunction",
      "Something that goes wrong with the devices of a sensor while an observatory's software "
      "commands them. An exposure has what holds when it begins.",
      {required("kind", form::choice({std::begin(malfunction_names), std::end(malfunction_names)}),
                "lost_link: its devices do not answer. slow_download: images come later. "
                "stuck_shutter: it stays closed. stopped_mount: the axis stands still, and the "
                "telescope tells that it moves. wrong_gain: it is told wrong."),
       required("at_s", form::not_negative(), "When it begins, after the start of the run [s]."),
       required("for_s", form::above(0.0, 1e9), "How long it lasts [s]."),
       optional("download_s", form::number(0.0, 3600.0),
                "From the end of an exposure to its image [s]; of slow_download, which needs it."),
       optional("gain_e_per_dn", form::above(0.0, 1e6),
                "The gain that is told [e-/DN]; of wrong_gain, which needs it.")}};
  return section;
}

namespace {

/// The value of a key that one kind of malfunction needs and no other may have.
double value_of(YamlMap& map, const char* key, bool is_of_kind) {
  if (is_of_kind) return map.require(key).number();
  if (const auto value = map.find(key)) value->fail("is of another kind of malfunction", false);
  return 0.0;
}

Malfunction read_malfunction(const YamlValue& value) {
  YamlMap map(value, malfunction_section());
  Malfunction m{.kind = MalfunctionKind(map.require("kind").chosen_index()),
                .at_s = map.number("at_s"),
                .for_s = map.number("for_s")};
  m.download_s = value_of(map, "download_s", m.kind == MalfunctionKind::slow_download);
  m.gain_e_per_dn = value_of(map, "gain_e_per_dn", m.kind == MalfunctionKind::wrong_gain);
  map.done();
  return m;
}

}  // namespace

std::vector<Malfunction> read_malfunctions(const YamlValue& list) {
  std::vector<Malfunction> malfunctions;
  for (const YamlValue& value : list.list()) malfunctions.push_back(read_malfunction(value));
  return malfunctions;
}

}  // namespace dmise
