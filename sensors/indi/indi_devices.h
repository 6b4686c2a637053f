#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sensors/indi/indi_vector.h"
#include "sensors/observatory/observatory.h"

namespace dmise {

/// What clients set of one device, beside what the device itself keeps.
struct IndiSession {
  bool connected = false;
  std::string coordinates = "TRACK";  // what a telescope does with coordinates that are given
  int slew_speed = 3;                 // which of the four speeds motions by hand have
  bool custom_rate = false;           // the telescope tracks at a rate that a client gave
  std::string element_set = {};       // TLE of a satellite that is to be followed
  std::string pass_start = {}, pass_end = {};
  std::string upload = "UPLOAD_CLIENT";  // where a camera's images go
  std::string frame_type = "FRAME_LIGHT";
  bool outward = true;                         // direction of relative motions of a focuser
  std::optional<std::string> noted_telescope;  // a client's name for that of a camera
  std::map<std::string, IndiState> after;      // a property's last command: ok or alert
};

struct IndiDeviceKind;

/// A call of one property of a device.
using IndiCall = StationCall<IndiDeviceKind, IndiSession>;

/// What a property has.
struct IndiReading {
  std::vector<IndiItem> items;
  std::optional<IndiState> state = {};           // none: that of its last command
  std::shared_ptr<const TakenImage> image = {};  // what a BLOB contains
};

/// New values of a property: those that are given, else those it has.
struct IndiGiven {
  std::vector<IndiItem> items;
  std::string chosen;  // the switch that is to be on; empty: none

  double number(const std::string& item) const;
  const std::string& text(const std::string& item) const;
};

/// A property of a kind of device.
struct IndiProperty {
  IndiTitle title;
  IndiReading (*read)(const IndiCall&);
  void (*write)(const IndiCall&, const IndiGiven&) = nullptr;  // null: it cannot be set
  bool (*exists)(const IndiCall&) = nullptr;                   // null: whenever it is connected
  bool told_when_asked = false;       // changes of its values alone are not told
  bool updated_when_defined = false;  // an update with the same values follows its definition
};

// The properties of a device; those that all devices have are in the first.
const std::vector<IndiProperty>& indi_common_properties();
const std::vector<IndiProperty>& indi_telescope_properties();
const std::vector<IndiProperty>& indi_camera_properties();
const std::vector<IndiProperty>& indi_focuser_properties();
const std::vector<IndiProperty>& indi_filter_wheel_properties();
const std::vector<IndiProperty>& indi_cover_properties();
const std::vector<IndiProperty>& indi_weather_properties();

/// A kind of device of which each station has one.
struct IndiDeviceKind {
  int interface;  // bits of `DRIVER_INTERFACE`
  std::string (*name)(const SensorConfig& sensor);
  const std::vector<IndiProperty>& (*properties)();
};

/// What clients are told of a property.
struct IndiNews {
  std::string device, property;
  bool blob = false;
  std::string xml;
};

/// The devices of an observatory as INDI has them: one of each kind at each station.
class IndiDevices {
 public:
  explicit IndiDevices(Observatory& observatory);

  /// The definitions that a client asks for.
  std::vector<IndiNews> defined(const GetIndiProperties& asked);
  /// Sets a property; returns what all clients are told. What it refuses is an update with Alert
  /// and a message. Throws `DeviceError` if there is no such property.
  std::vector<IndiNews> set(const NewIndiVector& given);
  /// Whether a client wants the BLOBs of a property.
  using WantsBlob = std::function<bool(const std::string& device, const std::string& property)>;
  /// What has changed since clients were told last. Images are encoded if one wants them.
  std::vector<IndiNews> changes(const WantsBlob& wants);

 private:
  struct Property {
    const IndiProperty* of;
    std::optional<IndiVector> told;           // none: it is not defined
    std::shared_ptr<const TakenImage> image;  // that was there
  };
  struct Device {
    const IndiDeviceKind* kind;
    std::string name;
    std::size_t station;
    IndiSession session;
    std::vector<Property> properties;
  };

  void add(const IndiDeviceKind& kind, std::size_t station);
  IndiCall call_of(Device& device) {
    return {*device.kind, observatory_, device.station, device.session};
  }
  bool exists(Device& device, const IndiProperty& property);
  IndiVector vector_of(Device& device, const IndiProperty& property, const IndiReading& reading);
  IndiRemark remark(const std::string& message = {}) const;
  Device& device_named(const std::string& name);
  Property& property_named(Device& device, const std::string& name);
  std::string write(Device& device, const IndiProperty& property, const NewIndiVector& given);
  void define(Device& device, Property& property, std::vector<IndiNews>& news);
  void define_or_delete(Device& device, std::vector<IndiNews>& news);
  void tell_image(Device& device, const IndiVector& vector, const TakenImage& image,
                  std::vector<IndiNews>& news);
  void add_changes(Device& device, Property& property, const WantsBlob& wants,
                   std::vector<IndiNews>& news);

  Observatory& observatory_;
  std::vector<Device> devices_;
};

}  // namespace dmise
