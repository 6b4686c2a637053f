#include <cmath>

#include "core/base/formatted.h"
#include "sensors/alpaca/alpaca_devices.h"

namespace dmise {
namespace {

using Call = MemberCall;
using Devices = Observatory::Devices;

constexpr int monochrome = 0;

[[noreturn]] void refuse(DeviceFault fault, const std::string& reason) {
  throw DeviceError(fault, reason);
}

const Optics& optics(const Call& c) { return c.sensor().camera.optics; }
const Detector& detector(const Call& c) { return c.sensor().camera.detector; }
double told_gain(const Call& c) { return c.observatory.told_gain_e_per_dn(c.station); }

template <class Ask>
MemberAnswer of_camera(const Call& c, const Ask& ask) {
  return answer_of(c.of([&](const Devices& d) { return ask(d.camera, d.now); }));
}
template <class Work>
MemberAnswer on_camera(const Call& c, const Work& work) {
  c.on([&](const Devices& d) { work(d.camera, d.now); });
  return {};
}

/// Chooses among one: of gains, offsets and modes of readout.
MemberAnswer choose_first(const Call& c, const char* name) {
  if (c.given.integer(name) != 0)
    refuse(DeviceFault::invalid_value, std::string(name) + " must be 0: there is one");
  return {};
}

MemberAnswer binning(const Call& c) {
  return of_camera(c, [](CameraControl& k, SimTime) { return k.window().bin_x; });
}
template <char axis>
MemberAnswer set_binning(const Call& c) {
  const int bin = c.given.integer(axis == 'x' ? "BinX" : "BinY");
  return on_camera(c, [&](CameraControl& k, SimTime) { k.set_bin(bin); });
}

MemberAnswer camera_state(const Call& c) {
  StateItems items;
  c.on([&](const Devices& d) {
    items.add("CameraState", int(d.camera.state(d.now)));
    items.add("CCDTemperature", d.camera.temperature_c(d.now));
    items.add("CoolerPower", d.camera.cooler_power_percent(d.now));
    items.add("ImageReady", d.camera.image_ready());
    if (d.camera.state(d.now) != CameraState::error)
      items.add("PercentCompleted", d.camera.percent_completed(d.now));
  });
  return items.take();
}

std::vector<Member> camera_facts() {
  return {
      {"cameraxsize", [](const Call& c) { return answer_of(optics(c).columns); }},
      {"cameraysize", [](const Call& c) { return answer_of(optics(c).rows); }},
      {"pixelsizex", [](const Call& c) { return answer_of(optics(c).pixel_pitch_m * 1e6); }},
      {"pixelsizey", [](const Call& c) { return answer_of(optics(c).pixel_pitch_m * 1e6); }},
      {"electronsperadu", [](const Call& c) { return answer_of(told_gain(c)); }},
      {"fullwellcapacity", [](const Call& c) { return answer_of(detector(c).full_well_e); }},
      {"maxadu",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.max_adu(); });
       }},
      {"exposuremin", [](const Call&) { return answer_of(min_commanded_exposure_s); }},
      {"exposuremax", [](const Call&) { return answer_of(max_commanded_exposure_s); }},
      {"exposureresolution", [](const Call&) { return answer_of(1e-6); }},
      {"maxbinx", [](const Call&) { return answer_of(max_bin); }},
      {"maxbiny", [](const Call&) { return answer_of(max_bin); }},
      {"sensorname", [](const Call& c) { return answer_of(c.sensor().camera.name); }},
      {"sensortype", [](const Call&) { return answer_of(monochrome); }},
      {"devicestate", camera_state},
      {"hasshutter", answer_yes},
      {"canabortexposure", answer_yes},
      {"canstopexposure", answer_yes},
      {"canasymmetricbin", answer_no},
      {"canfastreadout", answer_no},
      {"canpulseguide", answer_no},
      {"bayeroffsetx", not_there},
      {"bayeroffsety", not_there},
      {"fastreadout", not_there, not_there},
      {"subexposureduration", not_there, not_there},
      {"pulseguide", nullptr, not_there},
      {"ispulseguiding", not_there},
      {"gains",
       [](const Call& c) {
         return answer_of(std::vector<std::string>{formatted("%g e-/DN", told_gain(c))});
       }},
      {"gain", [](const Call&) { return answer_of(0); },
       [](const Call& c) { return choose_first(c, "Gain"); }},
      {"gainmin", not_there},
      {"gainmax", not_there},
      {"offsets",
       [](const Call& c) {
         return answer_of(std::vector<std::string>{formatted("%g DN", detector(c).bias_dn)});
       }},
      {"offset", [](const Call&) { return answer_of(0); },
       [](const Call& c) { return choose_first(c, "Offset"); }},
      {"offsetmin", not_there},
      {"offsetmax", not_there},
      {"readoutmodes", [](const Call&) { return answer_of(std::vector<std::string>{"Normal"}); }},
      {"readoutmode", [](const Call&) { return answer_of(0); },
       [](const Call& c) { return choose_first(c, "ReadoutMode"); }},
  };
}

std::vector<Member> camera_settings() {
  return {
      {"binx", binning, set_binning<'x'>},
      {"biny", binning, set_binning<'y'>},
      {"startx",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.window().x; });
       },
       [](const Call& c) {
         const int x = c.given.integer("StartX");
         return on_camera(c, [&](CameraControl& k, SimTime) { k.set_start(x, std::nullopt); });
       }},
      {"starty",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.window().y; });
       },
       [](const Call& c) {
         const int y = c.given.integer("StartY");
         return on_camera(c, [&](CameraControl& k, SimTime) { k.set_start(std::nullopt, y); });
       }},
      {"numx",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.window().columns; });
       },
       [](const Call& c) {
         const int x = c.given.integer("NumX");
         return on_camera(c, [&](CameraControl& k, SimTime) { k.set_size(x, std::nullopt); });
       }},
      {"numy",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.window().rows; });
       },
       [](const Call& c) {
         const int y = c.given.integer("NumY");
         return on_camera(c, [&](CameraControl& k, SimTime) { k.set_size(std::nullopt, y); });
       }},
      {"ccdtemperature",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime now) { return k.temperature_c(now); });
       }},
      {"heatsinktemperature",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.ambient_c(); });
       }},
      {"cansetccdtemperature",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.has_cooler(); });
       }},
      {"cangetcoolerpower",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.has_cooler(); });
       }},
      {"setccdtemperature",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) {
           k.need_cooler();
           return k.goal_c();
         });
       },
       [](const Call& c) {
         const double goal_c = c.given.number("SetCCDTemperature");
         return on_camera(c, [&](CameraControl& k, SimTime now) { k.set_goal_c(goal_c, now); });
       }},
      {"cooleron",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) {
           k.need_cooler();
           return k.cooler_on();
         });
       },
       [](const Call& c) {
         const bool on = c.given.flag("CoolerOn");
         return on_camera(c, [&](CameraControl& k, SimTime now) { k.set_cooler(on, now); });
       }},
      {"coolerpower",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime now) {
           k.need_cooler();
           return k.cooler_power_percent(now);
         });
       }},
  };
}

MemberAnswer image(const Call& c) {
  return {.image = c.of([](const Devices& d) { return d.camera.image(); })};
}

std::vector<Member> camera_exposures() {
  return {
      {"startexposure", nullptr,
       [](const Call& c) {
         const double exposure_s = c.given.number("Duration");
         c.observatory.start_exposure(c.station, exposure_s, c.given.flag("Light"));
         return MemberAnswer{};
       }},
      {"stopexposure", nullptr,
       [](const Call& c) {
         c.observatory.stop_exposure(c.station);
         return MemberAnswer{};
       }},
      {"abortexposure", nullptr,
       [](const Call& c) {
         c.observatory.abort_exposure(c.station);
         return MemberAnswer{};
       }},
      {"camerastate",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime now) { return int(k.state(now)); });
       }},
      {"imageready",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime now) {
           if (k.state(now) == CameraState::error) k.image();  // says why
           return k.image_ready();
         });
       }},
      {"imagearray", image},
      {"imagearrayvariant", image},
      {"percentcompleted",
       [](const Call& c) {
         return of_camera(c,
                          [](CameraControl& k, SimTime now) { return k.percent_completed(now); });
       }},
      {"lastexposureduration",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.last_exposure_s(); });
       }},
      {"lastexposurestarttime",
       [](const Call& c) {
         return of_camera(c, [](CameraControl& k, SimTime) { return k.last_start_utc(); });
       }},
  };
}

}  // namespace

const std::vector<Member>& camera_members() {
  static const std::vector<Member> members = [] {
    std::vector<Member> all = camera_facts();
    for (const auto& more : {camera_settings(), camera_exposures()})
      all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return members;
}

}  // namespace dmise
