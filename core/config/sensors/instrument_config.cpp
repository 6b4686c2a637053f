#include "core/config/sensors/instrument_config.h"

#include <iterator>

#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/config/yaml/yaml_reader.h"

namespace dmise {
namespace {

using Kind = InstrumentParameter::Kind;

Forms forms_of(const InstrumentParameter& p) {
  if (p.kind == Kind::list) return form::list(form::number(0.0, p.most));
  const bool is_rms = p.kind == Kind::rms || p.kind == Kind::rms_of_axes;
  const double least = is_rms ? 0.0 : -p.most;
  if (std::holds_alternative<double Instrument::*>(p.value)) return form::number(least, p.most);
  const Forms axes = form::numbers(ImageAxes().size(), least, p.most);
  return p.kind == Kind::rms_of_axes ? form::number(least, p.most) | axes : axes;
}

template <class Effect>
const Section& section_of() {
  static const Section section = [] {
    Section made{std::string(Effect::facts.name), sentence_of(Effect::facts.what), {}};
    for (const auto& p : Effect::parameters())
      made.keys.push_back(optional(std::string(p.key), forms_of(p), std::string(p.meaning),
                                   std::get_if<double Instrument::*>(&p.value) ? "0" : ""));
    return made;
  }();
  return section;
}

void read_number(const YamlValue& value, const InstrumentParameter& p, Instrument& instrument) {
  if (const auto* number = std::get_if<double Instrument::*>(&p.value)) {
    instrument.** number = value.number() * p.unit;
    return;
  }
  if (const auto* list = std::get_if<std::vector<double> Instrument::*>(&p.value)) {
    for (const double number : value.numbers()) (instrument.**list).push_back(number * p.unit);
    return;
  }
  ImageAxes& axes = instrument.*std::get<ImageAxes Instrument::*>(p.value);
  if (p.kind == Kind::rms_of_axes && value.is_scalar()) {
    axes[0] = axes[1] = value.number() * p.unit;
    return;
  }
  const auto numbers = value.numbers();
  for (std::size_t k = 0; k < axes.size(); ++k) axes[k] = numbers[k] * p.unit;
}

template <class Effect>
void read_effect(const YamlValue& value, Instrument& instrument) {
  YamlMap map(value, section_of<Effect>());
  std::vector<const InstrumentParameter*> given;
  std::string keys;
  for (const auto& p : Effect::parameters()) {
    keys += (keys.empty() ? "" : ", ") + std::string(p.key);
    const auto number = map.find(p.key);
    if (!number) continue;
    for (const auto* other : given)
      if (other->value == p.value)
        number->fail("give one of " + std::string(other->key) + " and " + std::string(p.key),
                     false);
    read_number(*number, p, instrument);
    given.push_back(&p);
  }
  map.done();
  if (given.empty()) value.fail("needs one of " + keys, false);
  if constexpr (requires(const Effect& effect) { effect.fault(); }) {
    const std::string_view fault = static_cast<const Effect&>(instrument).fault();
    if (!fault.empty()) value.fail(std::string(fault), false);
  }
}

}  // namespace

std::vector<Key> instrument_keys() {
  std::vector<Key> keys;
  InstrumentEffects::for_each([&]<class Effect>() {
    keys.push_back(optional(std::string(Effect::facts.name), form::map(section_of<Effect>),
                            sentence_of(Effect::facts.what)));
  });
  return keys;
}

void read_instrument(YamlMap& sensor, Instrument& instrument) {
  InstrumentEffects::for_each([&]<class Effect>() {
    if (const auto value = sensor.find(Effect::facts.name)) read_effect<Effect>(*value, instrument);
  });
}

void check_clock(YamlMap& map, const SensorConfig& sensor, SimTime duration) {
  const ClockError clock = acting_instrument(sensor.instrument, sensor.effects);
  if (!clock.applies()) return;
  const SimTime first = sim_seconds(sensor.first_exposure_s);
  const YamlValue value = map.require(ClockError::facts.name);
  if (const SimTime begins = clock.earliest(first); begins < SimTime{})
    value.fail(formatted("the first exposure may begin before the run; first_exposure_s must be >= "
                         "%.6g",
                         sensor.first_exposure_s - begins.seconds()),
               false);
  if (first + sim_seconds(sensor.exposure_s) > clock.surely_read_by(duration))
    value.fail("the first exposure may end after the run does", false);
}

std::vector<double> numbers_of(const InstrumentParameter& p, const Instrument& instrument) {
  if (const auto* number = std::get_if<double Instrument::*>(&p.value))
    return {instrument.**number / p.unit};
  std::vector<double> numbers;
  if (const auto* list = std::get_if<std::vector<double> Instrument::*>(&p.value)) {
    for (const double number : instrument.**list) numbers.push_back(number / p.unit);
    return numbers;
  }
  for (const double number : instrument.*std::get<ImageAxes Instrument::*>(p.value))
    numbers.push_back(number / p.unit);
  return numbers;
}

void write_instrument_json(JsonWriter& json, const Instrument& instrument) {
  InstrumentEffects::for_each([&]<class Effect>() {
    if (!static_cast<const Effect&>(instrument).applies()) return;
    json.key(Effect::facts.name).begin_object();
    for (const auto& p : Effect::parameters()) json.list(p.key, numbers_of(p, instrument));
    json.end_object();
  });
}

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
