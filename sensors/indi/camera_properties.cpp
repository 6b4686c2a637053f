#include <cmath>

#include "sensors/indi/property_items.h"

namespace dmise {
namespace {

using Call = IndiCall;
using Given = IndiGiven;
using Devices = Observatory::Devices;

constexpr double temperature_reached_k = 0.2;
constexpr std::size_t max_noted_bytes = 200;

struct FrameType {
  const char *name, *label;
};
constexpr FrameType frame_types[] = {{"FRAME_LIGHT", "Light"},
                                     {"FRAME_BIAS", "Bias"},
                                     {"FRAME_DARK", "Dark"},
                                     {"FRAME_FLAT", "Flat"}};

/// A part of the detector, in its own pixels.
struct Part {
  int x = 0, y = 0, columns = 0, rows = 0;
};

Part part_of(const Window& w) {
  return {w.x * w.bin_x, w.y * w.bin_y, w.columns * w.bin_x, w.rows * w.bin_y};
}

void take_part(CameraControl& camera, const Part& part) {
  const Optics& optics = camera.camera().optics;
  const Window& w = camera.window();
  if (part.columns > optics.columns - part.x || part.rows > optics.rows - part.y)
    refuse_value("it reaches beyond " + std::to_string(optics.columns) + " x " +
                 std::to_string(optics.rows) + " pixels");
  if (part.columns < w.bin_x || part.rows < w.bin_y)
    refuse_value("it is smaller than a binned pixel");
  camera.set_start(part.x / w.bin_x, part.y / w.bin_y);
  camera.set_size(part.columns / w.bin_x, part.rows / w.bin_y);
}

/// The part of the detector stays, as far as binned pixels have it.
void set_binning(CameraControl& camera, int bin) {
  const Part part = part_of(camera.window());
  const Window& w = camera.window();
  const Optics& optics = camera.camera().optics;
  const bool whole = w.x == 0 && w.y == 0 && w.columns == optics.columns / w.bin_x &&
                     w.rows == optics.rows / w.bin_y;
  if (!whole && (part.columns < bin || part.rows < bin))
    refuse_value("the frame is smaller than a binned pixel");
  camera.set_bin(bin);  // a whole frame stays whole
  if (!whole) take_part(camera, part);
}

IndiReading exposure(const Call& c) {
  return c.of([](const Devices& d) {
    IndiReading reading{
        {number_item("CCD_EXPOSURE_VALUE", "Duration (s)", d.camera.left_s(d.now),
                     {"%5.3f", min_commanded_exposure_s, max_commanded_exposure_s, 1.0, 0.25})}};
    switch (d.camera.state(d.now)) {
      case CameraState::idle:
        reading.state = d.camera.image_ready() ? IndiState::ok : IndiState::idle;
        break;
      case CameraState::error:
        reading.state = IndiState::alert;
        break;
      default:
        reading.state = IndiState::busy;
    }
    return reading;
  });
}

IndiReading frame_type(const Call& c) {
  IndiReading reading;
  for (const FrameType& type : frame_types)
    reading.items.push_back(switch_item(type.name, type.label, c.session.frame_type == type.name));
  return reading;
}

bool has_light(const std::string& frame_type) {
  return frame_type == "FRAME_LIGHT" || frame_type == "FRAME_FLAT";
}

IndiReading image(const Call& c) {
  return c.of([](const Devices& d) {
    const bool busy = d.camera.state(d.now) == CameraState::exposing ||
                      d.camera.state(d.now) == CameraState::reading;
    const auto taken = d.camera.taken();
    return IndiReading{{text_item("CCD1", "Image", "")},
                       busy    ? IndiState::busy
                       : taken ? IndiState::ok
                               : IndiState::idle,
                       taken};
  });
}

IndiReading frame(const Call& c) {
  const Part p = c.of([](const Devices& d) { return part_of(d.camera.window()); });
  const Optics& o = c.sensor().camera.optics;
  const auto range = [](int low, int high) {
    return IndiRange{"%4.0f", double(low), double(high), 1.0};
  };
  return {{number_item("X", "Left", p.x, range(0, o.columns - 1)),
           number_item("Y", "Top", p.y, range(0, o.rows - 1)),
           number_item("WIDTH", "Width", p.columns, range(1, o.columns)),
           number_item("HEIGHT", "Height", p.rows, range(1, o.rows))}};
}

void set_frame(const Call& c, const Given& given) {
  const auto whole = [&](const char* item) { return int(std::floor(given.number(item))); };
  const Part part{whole("X"), whole("Y"), whole("WIDTH"), whole("HEIGHT")};
  c.on([&](const Devices& d) { take_part(d.camera, part); });
}

void reset_frame(const Call& c, const Given&) {
  c.on([](const Devices& d) {
    const Optics& o = d.camera.camera().optics;
    d.camera.set_bin(1);
    take_part(d.camera, {0, 0, o.columns, o.rows});
  });
}

IndiReading binning(const Call& c) {
  const Window w = c.of([](const Devices& d) { return d.camera.window(); });
  const IndiRange bins{"%2.0f", 1.0, double(max_bin), 1.0};
  return {{number_item("HOR_BIN", "X", w.bin_x, bins), number_item("VER_BIN", "Y", w.bin_y, bins)}};
}

void choose_binning(const Call& c, const Given& given) {
  const double bin = given.number("HOR_BIN");
  if (bin != given.number("VER_BIN")) refuse_value("both binnings must be the same");
  if (bin != std::floor(bin)) refuse_value("binning must be a whole number");
  c.on([&](const Devices& d) { set_binning(d.camera, int(bin)); });
}

IndiReading camera_info(const Call& c) {
  const Optics& o = c.sensor().camera.optics;
  const double pitch_um = o.pixel_pitch_m * 1e6;
  const IndiRange pixels{"%4.0f", 1.0, 100000.0}, um{"%5.2f", 0.0, 1000.0},
      bits{"%2.0f", 8.0, 64.0};
  return {{number_item("CCD_MAX_X", "Max. Width", o.columns, pixels),
           number_item("CCD_MAX_Y", "Max. Height", o.rows, pixels),
           number_item("CCD_PIXEL_SIZE", "Pixel size (um)", pitch_um, um),
           number_item("CCD_PIXEL_SIZE_X", "Pixel size X", pitch_um, um),
           number_item("CCD_PIXEL_SIZE_Y", "Pixel size Y", pitch_um, um),
           number_item("CCD_BITSPERPIXEL", "Bits per pixel", 16, bits)}};
}

bool has_cooler(const Call& c) {
  return c.of([](const Devices& d) { return d.camera.has_cooler(); });
}
bool has_no_cooler(const Call& c) { return !has_cooler(c); }

IndiReading temperature(const Call& c) {
  return c.of([](const Devices& d) {
    const double now_c = d.camera.temperature_c(d.now);
    IndiReading reading{{number_item("CCD_TEMPERATURE_VALUE", "Temperature (C)", now_c,
                                     {"%5.2f", -100.0, 50.0, 1.0, 0.05})}};
    const bool cooling = d.camera.has_cooler() && d.camera.cooler_on();
    if (cooling && std::abs(now_c - d.camera.goal_c()) > temperature_reached_k)
      reading.state = IndiState::busy;
    return reading;
  });
}

/// Who sets a temperature wants it.
void set_temperature(const Call& c, const Given& given) {
  const double goal_c = given.number("CCD_TEMPERATURE_VALUE");
  c.on([&](const Devices& d) {
    d.camera.set_goal_c(goal_c, d.now);
    d.camera.set_cooler(true, d.now);
  });
}

IndiReading cooler(const Call& c) {
  const bool on = c.of([](const Devices& d) { return d.camera.cooler_on(); });
  return {{switch_item("COOLER_ON", "On", on), switch_item("COOLER_OFF", "Off", !on)}};
}

IndiReading cooler_power(const Call& c) {
  const double power = c.of([](const Devices& d) { return d.camera.cooler_power_percent(d.now); });
  return {{number_item("CCD_COOLER_VALUE", "Cooling Power (%)", power,
                       {"%.1f", 0.0, 100.0, 0.0, 0.5})}};
}

IndiReading upload_mode(const Call& c) {
  const std::string& mode = c.session.upload;
  return {{switch_item("UPLOAD_CLIENT", "Client", mode == "UPLOAD_CLIENT"),
           switch_item("UPLOAD_LOCAL", "Local", mode == "UPLOAD_LOCAL"),
           switch_item("UPLOAD_BOTH", "Both", mode == "UPLOAD_BOTH")}};
}

/// Files are written in every mode, and told where a client takes them from this machine's disk.
IndiReading file_path(const Call& c) {
  const auto taken = c.of([](const Devices& d) { return d.camera.taken(); });
  return {{text_item("FILE_PATH", "Path",
                     taken ? c.observatory.frame_path(c.station, taken->header.frame) : "")}};
}
bool tells_files(const Call& c) { return c.session.upload != "UPLOAD_CLIENT"; }

/// Its telescope is always that of its sensor; clients note here what they take for it.
IndiReading active_devices(const Call& c) {
  return {{text_item("ACTIVE_TELESCOPE", "Telescope",
                     c.session.noted_telescope.value_or(telescope_name(c.sensor())))}};
}

void set_active_devices(const Call& c, const Given& given) {
  const std::string& name = given.text("ACTIVE_TELESCOPE");
  if (name.size() > max_noted_bytes) refuse_value("the name is too long");
  c.session.noted_telescope = name;
}

std::vector<IndiProperty> exposures() {
  return {
      {texts("CCD_FILE_PATH", "Filename", info_group), file_path, nullptr, tells_files},
      {numbers("CCD_EXPOSURE", "Expose", main_group), exposure,
       [](const Call& c, const Given& given) {
         c.observatory.start_exposure(c.station, given.number("CCD_EXPOSURE_VALUE"),
                                      has_light(c.session.frame_type));
       }},
      // Read after CCD_EXPOSURE: an exposure that is over has its image.
      {{"CCD1", "Image Data", info_group, IndiKind::blob}, image},
      {at_most_one("CCD_ABORT_EXPOSURE", "Abort", main_group),
       [](const Call&) { return button("ABORT", "Abort"); },
       [](const Call& c, const Given&) { c.observatory.abort_exposure(c.station); }},
  };
}

std::vector<IndiProperty> settings() {
  return {
      {numbers("CCD_INFO", "CCD Information", info_group), camera_info},
      {numbers("CCD_FRAME", "Frame", image_group), frame, set_frame},
      {at_most_one("CCD_FRAME_RESET", "Frame Values", image_group),
       [](const Call&) { return button("RESET", "Reset"); }, reset_frame},
      {numbers("CCD_BINNING", "Binning", image_group), binning, choose_binning},
      {one_of("CCD_FRAME_TYPE", "Type", image_group), frame_type,
       [](const Call& c, const Given& given) { c.session.frame_type = given.chosen; }},
      {one_of("CCD_TRANSFER_FORMAT", "Encode", image_group),
       [](const Call&) { return IndiReading{{switch_item("FORMAT_FITS", "FITS", true)}}; },
       [](const Call&, const Given&) {}},
      {one_of("CCD_COMPRESSION", "Compression", image_group),
       [](const Call&) {
         return IndiReading{{switch_item("INDI_ENABLED", "Enabled", false),
                             switch_item("INDI_DISABLED", "Disabled", true)}};
       },
       [](const Call&, const Given& given) {
         if (given.chosen == "INDI_ENABLED") refuse_value("images are not compressed");
       }},
      {numbers("CCD_TEMPERATURE", "Temperature", main_group), temperature, nullptr, has_no_cooler},
      {numbers("CCD_TEMPERATURE", "Temperature", main_group), temperature, set_temperature,
       has_cooler},
      {one_of("CCD_COOLER", "Cooler", main_group), cooler,
       [](const Call& c, const Given& given) {
         c.on([&](const Devices& d) { d.camera.set_cooler(given.chosen == "COOLER_ON", d.now); });
       },
       has_cooler},
      {numbers("CCD_COOLER_POWER", "Cooling Power", main_group), cooler_power, nullptr, has_cooler},
      {one_of("UPLOAD_MODE", "Upload", options_group), upload_mode,
       [](const Call& c, const Given& given) { c.session.upload = given.chosen; }},
      {texts("ACTIVE_DEVICES", "Snoop devices", options_group), active_devices, set_active_devices},
  };
}

}  // namespace

const std::vector<IndiProperty>& indi_camera_properties() {
  static const std::vector<IndiProperty> properties = [] {
    std::vector<IndiProperty> all = settings();
    const auto more = exposures();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return properties;
}

}  // namespace dmise
