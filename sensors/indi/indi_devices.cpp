#include "sensors/indi/indi_devices.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/version.h"

namespace dmise {
namespace {

[[noreturn]] void refuse(const std::string& reason) {
  throw DeviceError(DeviceFault::invalid_value, reason);
}

template <class Items>
auto& item_named(Items& items, const std::string& name) {
  const auto found = std::ranges::find(items, name, [](const IndiItem& item) { return item.name; });
  if (found == items.end()) refuse("it has no item " + printable(name, 60));
  return *found;
}

double number_within(const IndiItem& item, const std::string& text) {
  const auto number = indi_number(text);
  const IndiRange& r = item.range;
  if (!number) refuse(std::string(item.name) + " must be a number, got " + printable(text, 60));
  if (r.low < r.high && !(*number >= r.low && *number <= r.high))
    refuse(std::string(item.name) + " must be " + shortest_text(r.low) + " to " +
           shortest_text(r.high) + ", got " + shortest_text(*number));
  return *number;
}

IndiGiven given_switches(std::vector<IndiItem> items, const NewIndiVector& given, IndiRule rule) {
  std::string chosen;
  for (const auto& [name, text] : given.values) {
    item_named(items, name);
    if (text != "On" && text != "Off")
      refuse(name + " must be On or Off, got " + printable(text, 60));
    if (text == "Off") continue;
    if (!chosen.empty()) refuse("only one may be On, got " + chosen + " and " + name);
    chosen = name;
  }
  if (chosen.empty() && rule == IndiRule::one_of_many) refuse("one must be On");
  return {std::move(items), chosen};
}

IndiGiven given_to(const IndiVector& vector, const NewIndiVector& given) {
  if (!vector.can_be_set) refuse("it can't be set");
  if (given.kind != vector.title.kind)
    refuse("it is set by new" + std::string(name_of(vector.title.kind)) + "Vector");
  if (given.values.empty()) refuse("no values are given");
  if (given.kind == IndiKind::toggle) return given_switches(vector.items, given, vector.title.rule);
  IndiGiven result{vector.items, {}};
  for (const auto& [name, text] : given.values) {
    IndiItem& item = item_named(result.items, name);
    if (given.kind == IndiKind::number)
      item.value = number_within(item, text);
    else
      item.value = text;
  }
  return result;
}

IndiReading connection(const IndiCall& c) {
  const bool on = c.session.connected;
  return {{{"CONNECT", "Connect", on}, {"DISCONNECT", "Disconnect", !on}},
          on ? IndiState::ok : IndiState::idle};
}

IndiReading driver(const IndiCall& c) {
  return {{{"DRIVER_NAME", "Name", c.kind.name(c.sensor())},
           {"DRIVER_EXEC", "Exec", std::string("dmise")},
           {"DRIVER_VERSION", "Version", std::string(software_name())},
           {"DRIVER_INTERFACE", "Interface", std::to_string(c.kind.interface)}}};
}

/// What was refused no longer matters when it does what it was told before.
void forget_refusal(IndiSession& session, const std::string& property) {
  const auto last = session.after.find(property);
  if (last != session.after.end() && last->second == IndiState::alert) session.after.erase(last);
}

bool always(const IndiCall&) { return true; }

/// In the order in which clients see them.
const std::vector<IndiDeviceKind>& kinds() {
  // Bits of INDI::BaseDevice::DRIVER_INTERFACE.
  constexpr int telescope = 1, ccd = 2, guider = 4, focuser = 8, filter = 16, weather = 128,
                dust_cap = 512;
  static const std::vector<IndiDeviceKind> all{
      {telescope | guider, telescope_name, indi_telescope_properties},
      {ccd, camera_name, indi_camera_properties},
      {focuser, focuser_name, indi_focuser_properties},
      {filter, wheel_name, indi_filter_wheel_properties},
      {dust_cap, cover_name, indi_cover_properties},
      {weather, weather_name, indi_weather_properties}};
  return all;
}

}  // namespace

double IndiGiven::number(const std::string& item) const {
  return std::get<double>(item_named(items, item).value);
}
const std::string& IndiGiven::text(const std::string& item) const {
  return std::get<std::string>(item_named(items, item).value);
}

const std::vector<IndiProperty>& indi_common_properties() {
  static const std::vector<IndiProperty> properties{
      {{"CONNECTION", "Connection", "Main Control", IndiKind::toggle},
       connection,
       [](const IndiCall& c, const IndiGiven& given) {
         c.session.connected = given.chosen == "CONNECT";
       },
       always},
      {{"DRIVER_INFO", "Driver", "General Info", IndiKind::text}, driver, nullptr, always}};
  return properties;
}

IndiDevices::IndiDevices(Observatory& observatory) : observatory_(observatory) {
  for (std::size_t i = 0; i < observatory_.size(); ++i)
    for (const IndiDeviceKind& kind : kinds()) add(kind, i);
  std::vector<IndiNews> nobody_hears;
  for (Device& device : devices_) define_or_delete(device, nobody_hears);
}

void IndiDevices::add(const IndiDeviceKind& kind, std::size_t station) {
  Device device{&kind, kind.name(observatory_.sensor(station)), station, {}, {}};
  for (const auto* list : {&indi_common_properties(), &kind.properties()})
    for (const IndiProperty& property : *list) device.properties.push_back({&property, {}, {}});
  devices_.push_back(std::move(device));
}

bool IndiDevices::exists(Device& device, const IndiProperty& property) {
  if (property.exists == always) return true;
  return device.session.connected && (!property.exists || property.exists(call_of(device)));
}

IndiVector IndiDevices::vector_of(Device& device, const IndiProperty& property,
                                  const IndiReading& reading) {
  const auto last = device.session.after.find(property.title.name);
  const IndiState commanded = last == device.session.after.end() ? IndiState::idle : last->second;
  IndiState state = reading.state.value_or(commanded);
  if (commanded == IndiState::alert && state != IndiState::busy) state = IndiState::alert;
  return {device.name, property.title, property.write != nullptr, state, reading.items};
}

IndiRemark IndiDevices::remark(const std::string& message) const {
  return {observatory_.utc(observatory_.now()), message};
}

void IndiDevices::define(Device& device, Property& property, std::vector<IndiNews>& news) {
  const IndiReading reading = property.of->read(call_of(device));
  const IndiVector vector = vector_of(device, *property.of, reading);
  if (!property.told) {
    property.told = vector;
    property.image = reading.image;  // what was taken before is not told
  }
  const char* name = vector.title.name;
  news.push_back({device.name, name, false, indi_definition(vector, remark())});
  if (property.of->updated_when_defined)
    news.push_back({device.name, name, false, indi_update(vector, remark())});
}

std::vector<IndiNews> IndiDevices::defined(const GetIndiProperties& asked) {
  std::vector<IndiNews> news;
  for (Device& device : devices_) {
    if (!asked.device.empty() && asked.device != device.name) continue;
    for (Property& property : device.properties)
      if (property.told && (asked.property.empty() || asked.property == property.of->title.name))
        define(device, property, news);
  }
  return news;
}

/// Defines what exists now, and deletes what does not any more.
void IndiDevices::define_or_delete(Device& device, std::vector<IndiNews>& news) {
  for (Property& property : device.properties) {
    const bool is_there = exists(device, *property.of);
    if (is_there == property.told.has_value()) continue;
    const char* name = property.of->title.name;
    if (is_there) {
      define(device, property, news);
      continue;
    }
    property.told.reset();
    news.push_back({device.name, name, false, indi_deletion(device.name, name, remark())});
  }
}

IndiDevices::Device& IndiDevices::device_named(const std::string& name) {
  const auto device = std::ranges::find(devices_, name, &Device::name);
  if (device == devices_.end()) refuse("there is no device " + printable(name, 60));
  return *device;
}

IndiDevices::Property& IndiDevices::property_named(Device& device, const std::string& name) {
  const auto property = std::ranges::find_if(
      device.properties, [&](const Property& p) { return p.told && p.of->title.name == name; });
  if (property == device.properties.end())
    refuse(device.name + " has no property " + printable(name, 60) +
           (device.session.connected ? "" : " before it is connected"));
  if (property->of->title.kind == IndiKind::blob) refuse(name + " can't be set");
  return *property;
}

/// Returns why it was refused; "" if it was not.
std::string IndiDevices::write(Device& device, const IndiProperty& property,
                               const NewIndiVector& given) {
  const IndiCall call = call_of(device);
  IndiState& after = device.session.after[property.title.name];
  try {
    if (!observatory_.has_link(device.station))
      refuse("the device does not answer: its link is lost");
    property.write(call, given_to(vector_of(device, property, property.read(call)), given));
    after = IndiState::ok;
    return {};
  } catch (const Error& error) {
    after = IndiState::alert;
    return printable(std::string(property.title.name) + ": " + error.what());
  }
}

std::vector<IndiNews> IndiDevices::set(const NewIndiVector& given) {
  Device& device = device_named(given.device);
  Property& property = property_named(device, given.property);
  const IndiProperty& of = *property.of;
  const std::string refused = write(device, of, given);
  IndiVector vector = vector_of(device, of, of.read(call_of(device)));
  if (!refused.empty())
    vector.state = IndiState::alert;  // also of what is busy with what it was told
  property.told = vector;
  std::vector<IndiNews> news{
      {device.name, of.title.name, false, indi_update(vector, remark(refused))}};
  define_or_delete(device, news);
  return news;
}

void IndiDevices::tell_image(Device& device, const IndiVector& vector, const TakenImage& image,
                             std::vector<IndiNews>& news) {
  if (device.session.upload == "UPLOAD_LOCAL") return;
  const Optics& optics = call_of(device).sensor().camera.optics;
  try {
    const std::string file = fits_of(image, is_whole(image.window, optics.columns, optics.rows));
    // Before the exposure is told to be over.
    news.insert(news.begin(), {device.name, vector.title.name, true,
                               indi_blob_update(vector, file, ".fits", remark())});
  } catch (const Error& error) {
    news.push_back({device.name, "", false, indi_message(device.name, remark(error.what()))});
  }
}

void IndiDevices::add_changes(Device& device, Property& property, const WantsBlob& wants,
                              std::vector<IndiNews>& news) {
  const IndiProperty& of = *property.of;
  const IndiReading reading = of.read(call_of(device));
  if (reading.state == IndiState::busy) forget_refusal(device.session, of.title.name);
  const IndiVector now = vector_of(device, of, reading);
  if (of.title.kind == IndiKind::blob) {  // its state is that of the next image
    if (reading.image && reading.image != property.image && wants(device.name, of.title.name))
      tell_image(device, now, *reading.image, news);
    property.image = reading.image;
    return;
  }
  const bool noticed =
      of.told_when_asked ? now.state != property.told->state : is_noticed(*property.told, now);
  if (!noticed) return;
  property.told = now;
  news.push_back({device.name, of.title.name, false, indi_update(now, remark())});
}

std::vector<IndiNews> IndiDevices::changes(const WantsBlob& wants) {
  std::vector<IndiNews> news;
  for (Device& device : devices_)
    for (Property& property : device.properties)
      if (device.session.connected && property.told && observatory_.has_link(device.station))
        add_changes(device, property, wants, news);
  return news;
}

}  // namespace dmise
